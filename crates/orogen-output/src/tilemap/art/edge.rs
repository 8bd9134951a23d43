//! The shape of a layer within a tile: the distance of a pixel from the layer's border.
//!
//! A tile is drawn in quadrants. A quadrant belongs to one cell. Its shape depends on whether the layer continues
//! across its two sides and its corner. In tiles of cells all four quadrants belong to one cell; in tiles on corners
//! each quadrant belongs to a different cell. So all layouts show the same borders.

use orogen_grid::autotile::mask::{E, Layout, N, NE, NW, S, SE, SW, W};

/// The position of a pixel relative to the border of its layer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BorderPoint {
    /// Distance to the border in pixels of a tile of 16: above 0 inside of the layer.
    pub inside: f64,
    /// How much the border faces south: -1 (north) to 1.
    pub south: f64,
}

/// A point far inside the layer.
const DEEP: BorderPoint = BorderPoint { inside: 16.0, south: 0.0 };

/// Radius of outer corners.
const RADIUS: f64 = 5.0;

/// A border: its distance from the sides of cells, and its waves.
#[derive(Debug, Clone, Copy)]
pub struct Border {
    /// Distance of the border from the side of its cell, in pixels of a tile of 16.
    pub inset: f64,
    /// Offsets along the middle of a side, in pixels of a tile of 16; the ends of a side have none, so that sides join.
    pub wave: [f64; 8],
}

impl Border {
    /// Distance from the side at a position along it, in pixels of a tile of 16.
    fn at(&self, along: f64) -> f64 {
        // Offsets apply to the centers of pixels of a tile of 16, and are interpolated linearly between them.
        let nth = along.rem_euclid(16.0) - 4.5;
        let offset = |n: f64| if (0.0..8.0).contains(&n) { self.wave[n as usize] } else { 0.0 };
        let (before, part) = (nth.floor(), nth - nth.floor());
        self.inset + offset(before) * (1.0 - part) + offset(before + 1.0) * part
    }

    /// The position of a pixel in a quadrant of a covered cell. `side` and `end` are the distances to the quadrant's
    /// horizontal and vertical side; `goes_on` says whether the layer continues across the horizontal side, the
    /// vertical side and the corner between them. `down` is 1 if the horizontal side is the southern one, else -1.
    /// `column` and `row` are the pixel's position, for the waves.
    fn quadrant(&self, [side, end]: [f64; 2], goes_on: [bool; 3], down: f64, [column, row]: [f64; 2]) -> BorderPoint {
        let (across, beside) = (side - self.at(column), end - self.at(row));
        match goes_on {
            [false, false, _] if across < RADIUS && beside < RADIUS => {
                let (a, b) = (RADIUS - across, RADIUS - beside);
                let far = libm::hypot(a, b);
                BorderPoint { inside: RADIUS - far, south: down * a / far.max(1e-9) }
            }
            [false, false, _] if across < beside => BorderPoint { inside: across, south: down },
            [false, false, _] => BorderPoint { inside: beside, south: 0.0 },
            [false, true, _] => BorderPoint { inside: across, south: down },
            [true, false, _] => BorderPoint { inside: beside, south: 0.0 },
            [true, true, false] => {
                let far = libm::hypot(side, end);
                BorderPoint { inside: far - self.inset, south: down * side / far.max(1e-9) }
            }
            [true, true, true] => DEEP,
        }
    }

    /// The position of the pixel at (x, y), in pixels of a tile of 16, in the tile for a mask; `None` where the layer
    /// has no cell.
    #[must_use]
    pub fn place(&self, layout: Layout, mask: u8, [x, y]: [f64; 2]) -> Option<BorderPoint> {
        let has = |bit: u8| mask & bit != 0;
        let (is_south, is_east) = (y >= 8.0, x >= 8.0);
        if !layout.is_on_corners() {
            // The quadrant's distances are measured to the cell's own sides.
            let (horizontal, vertical) = (if is_south { S } else { N }, if is_east { E } else { W });
            let corner = match (is_south, is_east) {
                (false, false) => NW,
                (false, true) => NE,
                (true, false) => SW,
                (true, true) => SE,
            };
            let corner = if layout == Layout::Edge { true } else { has(corner) };
            let distances = [if is_south { 16.0 - y } else { y }, if is_east { 16.0 - x } else { x }];
            let down = if is_south { 1.0 } else { -1.0 };
            return Some(self.quadrant(distances, [has(horizontal), has(vertical), corner], down, [x, y]));
        }
        // The center of a quadrant's cell is at the tile's corner, and its sides are in the middle of the tile.
        let (own, across, beside, corner) = match (is_south, is_east) {
            (false, false) => (NW, SW, NE, SE),
            (false, true) => (NE, SE, NW, SW),
            (true, false) => (SW, NW, SE, NE),
            (true, true) => (SE, NE, SW, NW),
        };
        let distances = [(8.0 - y).abs(), (8.0 - x).abs()];
        let down = if is_south { -1.0 } else { 1.0 };
        // The position along a side is relative to the cell, which begins in the middle of the tile.
        let place = self.quadrant(distances, [has(across), has(beside), has(corner)], down, [x + 8.0, y + 8.0]);
        has(own).then_some(place)
    }
}
