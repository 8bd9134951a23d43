//! The frame of a tile: from metres of the world to whole units of the tile.
//!
//! A line is cut at the border of the buffer, and has a point where it crosses a side of the tile, in both tiles the
//! same one. Between these points each tile simplifies it by itself, so that the lines of two tiles meet.

use orogen_grid::contour::line::twice_area;
use orogen_grid::hydrography::clip::Rectangle;
use orogen_io::format::features::{Feature, Geometry, Value};
use orogen_io::format::mvt::{TileFeature, TileGeometry};

use super::simplify::simplified;

/// Units along the side of a tile.
pub const EXTENT: u32 = 4096;

/// Width of the border around a tile that has lines and polygons, too, in units. Points have none: each is in one tile.
pub const BUFFER: u32 = 64;

/// Maximum distance of a simplified line from the exact one, in units, before rounding.
const TOLERANCE: f64 = 2.0;

/// Minimum length of the longer side of the box around a ring, in units.
const SMALLEST: f64 = 16.0;

/// The frame of a tile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TileFrame {
    /// The north-west corner, in metres east and south of the world's origin.
    pub origin: [f64; 2],
    /// Units of the tile per metre.
    pub scale: [f64; 2],
}

impl TileFrame {
    /// The feature with its geometry in units of the tile; `None` if nothing of it is in the tile or large enough.
    #[must_use]
    pub fn feature(&self, geometry: &Geometry, values: Vec<Value>) -> Option<TileFeature> {
        let geometry = match geometry {
            Geometry::Point([east, south, _]) => {
                let at = self.at([*east, *south]);
                let within = |unit: f64| (0.0..f64::from(EXTENT)).contains(&unit);
                // A point that rounds to the far side still belongs to this tile.
                at.iter().all(|unit| within(*unit)).then(|| TileGeometry::Points(vec![at.map(rounded)]))?
            }
            Geometry::Line(points) => {
                let path: Vec<[f64; 2]> = points.iter().map(|[east, south, _]| self.at([*east, *south])).collect();
                let lines = lines_of(&path);
                (!lines.is_empty()).then_some(TileGeometry::Lines(lines))?
            }
            Geometry::MultiPolygon(parts) => {
                let ring = |ring: &Vec<[f64; 2]>| ring.iter().map(|at| self.at(*at)).collect::<Vec<_>>();
                let rings: Vec<_> =
                    (parts.iter()).flat_map(|part| rings_of(&part.iter().map(ring).collect::<Vec<_>>())).collect();
                (!rings.is_empty()).then_some(TileGeometry::Rings(rings))?
            }
        };
        Some(TileFeature { geometry, values })
    }

    /// The features whose bounds (west, south, east, north of [`Feature::geometry`], in metres east and south) reach
    /// into the tile or its buffer.
    pub fn features<'a>(
        &'a self,
        features: impl Iterator<Item = (&'a Feature, [f64; 4])> + 'a,
    ) -> impl Iterator<Item = &'a Feature> + 'a {
        let margin = f64::from(BUFFER);
        let meets = move |bounds: &[f64; 4]| {
            let [a, b] = [self.at([bounds[0], bounds[1]]), self.at([bounds[2], bounds[3]])];
            (0..2).all(|k| a[k].min(b[k]) <= f64::from(EXTENT) + margin && a[k].max(b[k]) >= -margin)
        };
        features.filter(move |(_, bounds)| meets(bounds)).map(|(feature, _)| feature)
    }

    fn at(&self, [east, south]: [f64; 2]) -> [f64; 2] {
        [(east - self.origin[0]) * self.scale[0], (south - self.origin[1]) * self.scale[1]]
    }
}

/// Half a unit is rounded up, also below 0, so that both tiles at a border round alike.
fn rounded(unit: f64) -> i32 {
    (unit + 0.5).floor() as i32
}

fn buffered() -> Rectangle {
    let (low, high) = (-f64::from(BUFFER), f64::from(EXTENT + BUFFER));
    Rectangle { sides: [low, low, high, high] }
}

/// A line given in units, as lines of whole units.
#[must_use]
pub fn lines_of(path: &[[f64; 2]]) -> Vec<Vec<[i32; 2]>> {
    if path.len() > 3 && path.first() == path.last() && is_small(path) {
        return Vec::new();
    }
    let pieces = buffered().lines(&path.to_vec());
    pieces.iter().map(|piece| whole(piece)).filter(|line| line.len() > 1).collect()
}

/// A polygon given in units, an outer ring and its holes, as rings of whole units: outer rings have a positive area,
/// and each is followed by its holes.
fn rings_of(part: &[Vec<[f64; 2]>]) -> Vec<Vec<[i32; 2]>> {
    if part.first().is_none_or(|outer| is_small(outer)) {
        return Vec::new();
    }
    let mut rings = Vec::new();
    for part in buffered().polygons(part) {
        for (k, ring) in part.iter().enumerate() {
            let mut ring = whole(ring);
            ring.pop();
            let area = area(&ring);
            if ring.len() < 3 || area == 0 {
                if k == 0 {
                    break;
                }
                continue;
            }
            if (area > 0) != (k == 0) {
                ring.reverse();
            }
            rings.push(ring);
        }
    }
    rings
}

/// Twice the area of a ring by the formula of the specification.
fn area(ring: &[[i32; 2]]) -> i64 {
    let next = ring.iter().cycle().skip(1);
    ring.iter().zip(next).map(|(a, b)| i64::from(a[0]) * i64::from(b[1]) - i64::from(b[0]) * i64::from(a[1])).sum()
}

/// Whether a ring is too small to be shown.
fn is_small(ring: &[[f64; 2]]) -> bool {
    let side = |axis: usize| {
        let [low, high] = ring.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], point| {
            [low.min(point[axis]), high.max(point[axis])]
        });
        high - low
    };
    side(0).max(side(1)) < SMALLEST || twice_area(ring) == 0.0
}

/// A simplified line in whole units, without equal points one after the other.
fn whole(path: &[[f64; 2]]) -> Vec<[i32; 2]> {
    let (points, is_fixed) = crossed(path);
    let mut line: Vec<[i32; 2]> =
        simplified(&points, &is_fixed, TOLERANCE).into_iter().map(|point| point.map(rounded)).collect();
    line.dedup();
    line
}

/// A line with a point at each crossing with a side of the tile, and whether each point is at one.
fn crossed(path: &[[f64; 2]]) -> (Vec<[f64; 2]>, Vec<bool>) {
    let sides = [0.0, f64::from(EXTENT)];
    let at_side = |point: &[f64; 2]| point.iter().any(|unit| sides.contains(unit));
    let (mut points, mut is_fixed) = (Vec::with_capacity(path.len()), Vec::with_capacity(path.len()));
    let mut last: Option<[f64; 2]> = None;
    for b in path.iter().copied() {
        if let Some(a) = last {
            let mut between: Vec<(f64, [f64; 2])> = Vec::new();
            for (axis, side) in [0, 1].into_iter().flat_map(|axis| sides.map(|side| (axis, side))) {
                if (a[axis] < side) != (b[axis] < side) && a[axis] != side && b[axis] != side {
                    let along = (side - a[axis]) / (b[axis] - a[axis]);
                    let mut point = [a[0] + along * (b[0] - a[0]), a[1] + along * (b[1] - a[1])];
                    point[axis] = side;
                    between.push((along, point));
                }
            }
            between.sort_by(|a, b| a.0.total_cmp(&b.0));
            for (_, point) in between {
                points.push(point);
                is_fixed.push(true);
            }
        }
        points.push(b);
        is_fixed.push(at_side(&b));
        last = Some(b);
    }
    (points, is_fixed)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn circle(center: [f64; 2], radius: f64) -> Vec<[f64; 2]> {
        let at = |k: i32| {
            // Counter-clockwise with north up.
            let angle = -f64::from(k % 720) * std::f64::consts::PI / 360.0;
            [center[0] + radius * libm::cos(angle), center[1] + radius * libm::sin(angle)]
        };
        (0..=720).map(at).collect()
    }

    fn frame(column: i32) -> TileFrame {
        TileFrame { origin: [f64::from(column) * 512.0, 0.0], scale: [8.0; 2] }
    }

    #[test]
    fn lines_of_adjacent_tiles_meet() {
        let line =
            |center: [f64; 2]| Geometry::Line(circle(center, 100.3).into_iter().map(|[x, y]| [x, y, 0.0]).collect());
        let mut met = 0;
        for k in 0..20 {
            let line = line([512.0 + f64::from(k) * 3.7, 200.0 + f64::from(k) * 7.1]);
            let border = |column: i32, side: i32| {
                let feature = frame(column).feature(&line, Vec::new()).unwrap();
                let TileGeometry::Lines(lines) = feature.geometry else { panic!() };
                assert!(lines.iter().flatten().flatten().all(|unit| (-64..=4160).contains(unit)));
                let mut found: Vec<i32> =
                    lines.iter().flatten().filter(|point| point[0] == side).map(|point| point[1]).collect();
                found.sort_unstable();
                found
            };
            let (west, east) = (border(0, 4096), border(1, 0));
            assert_eq!(west, east);
            met += west.len();
        }
        assert_eq!(met, 40);
    }

    #[test]
    fn polygons_have_positive_outer_rings_and_their_area() {
        let (mut island, lake) = (circle([512.0, 200.0], 30.0), circle([512.0, 200.0], 100.0));
        island.reverse();
        let lake = Geometry::MultiPolygon(vec![vec![lake, island]]);
        for column in 0..2 {
            let TileGeometry::Rings(rings) = frame(column).feature(&lake, Vec::new()).unwrap().geometry else {
                panic!()
            };
            // The island cuts the buffer, so it is a bay.
            let half: f64 = rings.iter().map(|ring| area(ring) as f64 / 128.0).sum();
            let expect = std::f64::consts::PI * (100.0 * 100.0 - 30.0 * 30.0) / 2.0 + 8.0 * 2.0 * 70.0;
            assert!((half / expect - 1.0).abs() < 0.01, "{half} {expect}");
            assert!(area(&rings[0]) > 0 && rings.iter().all(|ring| ring.len() < 200));
        }
        // Far inside, the hole stays one.
        let (mut island, lake) = (circle([200.0, 200.0], 30.0), circle([200.0, 200.0], 100.0));
        island.reverse();
        let lake = Geometry::MultiPolygon(vec![vec![lake, island]]);
        let TileGeometry::Rings(rings) = frame(0).feature(&lake, Vec::new()).unwrap().geometry else { panic!() };
        assert_eq!((rings.len(), area(&rings[0]) > 0, area(&rings[1]) < 0), (2, true, true));
        // Elsewhere there is nothing, and a pond is too small.
        assert_eq!(frame(3).feature(&lake, Vec::new()), None);
        let pond = Geometry::MultiPolygon(vec![vec![circle([200.0, 200.0], 0.5)]]);
        assert_eq!(frame(0).feature(&pond, Vec::new()), None);
    }

    #[test]
    fn a_point_is_in_one_tile() {
        for x in [0.0, 511.96, 512.0, 700.3] {
            let point = Geometry::Point([x, 9.0, 0.0]);
            let found: Vec<i32> =
                (0..3).filter(|column| frame(*column).feature(&point, Vec::new()).is_some()).collect();
            assert_eq!(found, [(x / 512.0) as i32], "{x}");
        }
        assert_eq!([rounded(-0.5), rounded(0.5), rounded(-0.51)], [0, 1, -1]);
    }
}
