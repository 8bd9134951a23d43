//! Masks of neighbors, and the masks that each layout of tiles distinguishes.
//!
//! A mask has a bit for each of the eight directions, clockwise from the north: N 1, NE 2, E 4, SE 8, S 16, SW 32, W
//! 64, NW 128. These are the weights of the common "blob" tilesets, and the order of wang ids in Tiled. A bit is set if
//! the layer continues in that direction.

/// North.
pub const N: u8 = 1;
/// North-east.
pub const NE: u8 = 2;
/// East.
pub const E: u8 = 4;
/// South-east.
pub const SE: u8 = 8;
/// South.
pub const S: u8 = 16;
/// South-west.
pub const SW: u8 = 32;
/// West.
pub const W: u8 = 64;
/// North-west.
pub const NW: u8 = 128;

/// The four sides.
pub const SIDES: u8 = N | E | S | W;

/// The four corners.
pub const CORNERS: u8 = NE | SE | SW | NW;

/// Column and row of each direction, in the order of the bits.
pub const OFFSETS: [[i64; 2]; 8] = [[0, -1], [1, -1], [1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1]];

/// Each corner with the two sides that meet there.
const BESIDE: [(u8, u8); 4] = [(NE, N | E), (SE, S | E), (SW, S | W), (NW, N | W)];

/// The masks of the smallest common blob tilesets: a full tile, four sides, four outer and four inner corners. There is
/// no tile for necks of one cell, nor for areas that touch at a corner.
pub const SIMPLE_BLOB: [u8; 13] = [
    255,
    !(NW | N | NE),
    !(NE | E | SE),
    !(SE | S | SW),
    !(SW | W | NW),
    E | SE | S,
    S | SW | W,
    W | NW | N,
    N | NE | E,
    !NE,
    !SE,
    !SW,
    !NW,
];

/// The way in which tiles depend on their surroundings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Layout {
    /// 47 tiles: sides, and corners between two covered sides.
    Blob,
    /// 16 tiles: sides only, for paths, fences and walls.
    Edge,
    /// 16 tiles, one of them empty: a class at each corner of a tile. A map of W x H tiles has (W + 1) x (H + 1)
    /// classes.
    Corner,
    /// The tiles of [`Layout::Corner`], shifted by half a tile so that each class is in the middle of a cell: a map of
    /// W x H cells has (W + 1) x (H + 1) tiles.
    Dual,
    /// Any of the 256 surroundings, for tiles that are chosen by rules (see [`super::rule`]).
    Rule,
}

impl Layout {
    /// The layouts for which complete sets of tiles can be drawn.
    pub const ALL: [Layout; 4] = [Layout::Blob, Layout::Edge, Layout::Corner, Layout::Dual];

    /// The name of the layout, as on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Layout::Blob => "blob",
            Layout::Edge => "edge",
            Layout::Corner => "corner",
            Layout::Dual => "dual",
            Layout::Rule => "rule",
        }
    }

    /// The layout with this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Layout> {
        Layout::ALL.into_iter().chain([Layout::Rule]).find(|layout| layout.name() == name)
    }

    /// A short description of its use.
    #[must_use]
    pub const fn about(self) -> &'static str {
        match self {
            Layout::Blob => "47 tiles per class, for the sides of a cell and the corners between two covered sides",
            Layout::Edge => "16 tiles per class, for the sides of a cell",
            Layout::Corner => "15 tiles per class, for the classes at the corners of a tile",
            Layout::Dual => {
                "15 tiles per class, shifted by half a tile, so that four tiles meet in the middle of each cell"
            }
            Layout::Rule => "tiles chosen by rules for the eight neighboring cells",
        }
    }

    /// Whether classes are at the corners of tiles, so that a tile sees four classes. Otherwise classes belong to
    /// cells, and a tile sees its own class and those of eight neighbors.
    #[must_use]
    pub fn is_on_corners(self) -> bool {
        matches!(self, Layout::Corner | Layout::Dual)
    }

    /// The mask without the bits that do not affect the tile.
    #[must_use]
    pub fn reduced(self, mask: u8) -> u8 {
        match self {
            Layout::Edge => mask & SIDES,
            Layout::Corner | Layout::Dual => mask & CORNERS,
            Layout::Rule => mask,
            Layout::Blob => BESIDE.iter().fold(mask, |mask, (corner, sides)| match mask & sides == *sides {
                true => mask,
                false => mask & !corner,
            }),
        }
    }

    /// The mask of a tile that is completely covered.
    #[must_use]
    pub fn full(self) -> u8 {
        self.reduced(255)
    }

    /// The classes along the sides and at the corners of a tile, clockwise from the north, from the classes around it
    /// and its own class. Directions that the layout does not distinguish have 0. The lower class of two cells counts
    /// on their common side, and the lowest of four at their common corner, so neighbors agree. Tiles on corners have
    /// the class of each corner.
    #[inline]
    #[must_use]
    pub fn wang_id(self, around: [u8; 8], own: u8) -> [u8; 8] {
        if self.is_on_corners() {
            return around;
        }
        let mut id = [0; 8];
        for side in [0, 2, 4, 6] {
            id[side] = own.min(around[side]);
        }
        if self != Layout::Edge {
            for corner in [1, 3, 5, 7] {
                id[corner] = id[corner - 1].min(id[(corner + 1) % 8]).min(around[corner]);
            }
        }
        id
    }

    /// The directions that wang ids of the layout use, as a mask.
    #[must_use]
    pub fn directions(self) -> u8 {
        match self {
            Layout::Edge => SIDES,
            Layout::Corner | Layout::Dual => CORNERS,
            Layout::Blob | Layout::Rule => 255,
        }
    }

    /// Whether a tile with this mask covers its cell completely, so that nothing below it is visible.
    #[inline]
    #[must_use]
    pub fn is_full(self, mask: u8) -> bool {
        let full = self.full();
        mask & full == full
    }

    /// All reduced masks, in ascending order. Mask 0, the empty tile of [`Layout::Corner`] and [`Layout::Dual`], is not
    /// drawn and not included.
    #[must_use]
    pub fn masks(self) -> Vec<u8> {
        let first = u8::from(self.is_on_corners());
        (first..=255).filter(|mask| self.reduced(*mask) == *mask).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layouts_have_the_usual_numbers_of_tiles() {
        assert_eq!(Layout::ALL.map(|layout| layout.masks().len()), [47, 16, 15, 15]);
        assert_eq!(Layout::Blob.full(), 255);
    }

    /// Compares the 47 masks with the list that is usually published for blob tilesets.
    #[test]
    fn the_blob_masks_are_the_published_ones() {
        let published = [
            0, 1, 4, 5, 7, 16, 17, 20, 21, 23, 28, 29, 31, 64, 65, 68, 69, 71, 80, 81, 84, 85, 87, 92, 93, 95, 112,
            113, 116, 117, 119, 124, 125, 127, 193, 197, 199, 209, 213, 215, 221, 223, 241, 245, 247, 253, 255,
        ];
        assert_eq!(Layout::Blob.masks(), published);
    }

    #[test]
    fn reducing_again_changes_nothing() {
        for layout in Layout::ALL {
            for mask in 0..=255 {
                let once = layout.reduced(mask);
                assert_eq!(layout.reduced(once), once);
                assert_eq!(once & !mask, 0, "reducing only clears bits");
            }
        }
    }
}
