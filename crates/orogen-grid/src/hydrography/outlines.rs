//! Outlines of labeled samples: polygons that tile the plane, with bit-equal common borders.
//!
//! Each sample is the center of a square, and a polygon is the union of the squares with one label. Corners of borders
//! are cut (Chaikin) between the nodes where three polygons meet; nodes stay fixed. Borders cannot cross, because each
//! cut corner lies in its own triangle.

use super::joints::Path;
use super::rings::nested;
use crate::contour::chaikin::chaikin;
use crate::contour::line::Line;
use crate::grid::Grid;

/// The label outside the grid.
const AROUND: u32 = u32::MAX;

/// Steps along the sides of squares: east, south, west, north.
const STEPS: [(i64, i64); 4] = [(1, 0), (0, 1), (-1, 0), (0, -1)];

/// The polygons of each label from 1 to `count`, in columns and rows of the labels' lattice. A polygon is a list of
/// parts, each an outer ring and its holes. Corners are cut `rounds` times.
#[must_use]
pub fn outlines(labels: &Grid<u32>, count: usize, rounds: usize) -> Vec<Vec<Vec<Path>>> {
    let squares = Squares { labels, width: labels.width() as i64, height: labels.height() as i64 };
    let mut rings: Vec<Vec<Path>> = vec![Vec::new(); count];
    // Whether the upper side of a square was already followed to the west, with the square on the left.
    let mut walked = vec![false; labels.data().len()];
    for j in 0..squares.height {
        for i in 0..squares.width {
            let label = squares.at(i, j);
            let known = walked[(j * squares.width + i) as usize];
            if known || label == 0 || label as usize > count || squares.at(i, j - 1) == label {
                continue;
            }
            let ring = squares.walk(i, j, label, &mut walked);
            for simple in parted(ring) {
                rings[label as usize - 1].push(squares.smoothed(&simple, rounds));
            }
        }
    }
    let origin = [labels.window().x as f64 - 0.5, labels.window().y as f64 - 0.5];
    for point in rings.iter_mut().flatten().flatten() {
        *point = [point[0] + origin[0], point[1] + origin[1]];
    }
    rings.iter().map(|rings| nested(rings.iter().collect())).collect()
}

/// The squares of a grid, square (i, j) with its north-west corner at (i, j).
struct Squares<'a> {
    labels: &'a Grid<u32>,
    width: i64,
    height: i64,
}

impl Squares<'_> {
    fn at(&self, i: i64, j: i64) -> u32 {
        match (0..self.width).contains(&i) && (0..self.height).contains(&j) {
            true => self.labels[(i as usize, j as usize)],
            false => AROUND,
        }
    }

    /// The labels to the left and to the right of a step from a corner.
    fn beside(&self, (x, y): (i64, i64), step: usize) -> (u32, u32) {
        let (ne, se, sw, nw) = (self.at(x, y - 1), self.at(x, y), self.at(x - 1, y), self.at(x - 1, y - 1));
        match step {
            0 => (ne, se),
            1 => (se, sw),
            2 => (sw, nw),
            _ => (nw, ne),
        }
    }

    /// Follows the ring around squares that are connected by their sides. It starts at the north-east corner of square
    /// (i, j), whose upper side belongs to the ring.
    fn walk(&self, i: i64, j: i64, label: u32, walked: &mut [bool]) -> Vec<(i64, i64)> {
        let start = (i + 1, j);
        let (mut at, mut step) = (start, 2);
        let mut ring = Vec::new();
        loop {
            if step == 2 {
                // The square to the left of a step to the west is the square below it.
                walked[(at.1 * self.width + at.0 - 1) as usize] = true;
            }
            ring.push(at);
            at = (at.0 + STEPS[step].0, at.1 + STEPS[step].1);
            // Turns left if that keeps the same squares at the side, otherwise goes straight on, otherwise turns right.
            // Squares that touch only at a corner are therefore not connected.
            step = [step + 3, step, step + 1]
                .map(|step| step % 4)
                .into_iter()
                .find(|step| {
                    let (left, right) = self.beside(at, *step);
                    left == label && right != label
                })
                .unwrap_or((step + 2) % 4);
            if at == start && step == 2 {
                return ring;
            }
        }
    }

    /// Whether a corner is a node: more than two borders meet there, or it is a corner of the grid.
    fn is_node(&self, at: (i64, i64)) -> bool {
        let corner = (at.0 == 0 || at.0 == self.width) && (at.1 == 0 || at.1 == self.height);
        let borders = (0..4).filter(|step| {
            let (left, right) = self.beside(at, *step);
            left != right
        });
        corner || borders.count() > 2
    }

    /// A ring with its corners cut between nodes, in columns and rows. Straight parts keep only their ends.
    fn smoothed(&self, ring: &[(i64, i64)], rounds: usize) -> Path {
        let point = |at: &(i64, i64)| [at.0 as f64, at.1 as f64];
        let line = |points: Vec<[f64; 2]>, closed| Line { elevation: 0.0, level: 0, closed, points };
        let nodes: Vec<usize> = (0..ring.len()).filter(|k| self.is_node(ring[*k])).collect();
        let mut points: Path = Vec::new();
        match nodes.first() {
            None => points = chaikin(&line(ring.iter().map(point).collect(), true), rounds).points,
            Some(first) => {
                let ends = nodes.iter().skip(1).copied().chain([first + ring.len()]);
                for (start, end) in nodes.iter().zip(ends) {
                    let arc = (*start..=end).map(|k| point(&ring[k % ring.len()])).collect();
                    let arc = chaikin(&line(arc, false), rounds).points;
                    points.extend_from_slice(&arc[..arc.len() - 1]);
                }
            }
        }
        let fixed: Vec<[f64; 2]> = nodes.iter().map(|k| point(&ring[*k])).collect();
        straightened(&points, &fixed)
    }
}

/// A closed ring without the points on a straight line between their neighbors, except for fixed points.
fn straightened(points: &[[f64; 2]], fixed: &[[f64; 2]]) -> Path {
    let count = points.len();
    let mut next_fixed = fixed.iter().peekable();
    let mut kept: Path = Vec::with_capacity(count + 1);
    for k in 0..count {
        let ([ax, ay], [x, y], [bx, by]) = (points[(k + count - 1) % count], points[k], points[(k + 1) % count]);
        // Nodes are in the order of the ring.
        let stays = next_fixed.next_if(|node| **node == [x, y]).is_some();
        if stays || (x - ax) * (by - y) != (y - ay) * (bx - x) {
            kept.push([x, y]);
        }
    }
    kept.extend(kept.first().copied());
    kept
}

/// Splits a ring into rings that do not touch themselves.
fn parted(ring: Vec<(i64, i64)>) -> Vec<Vec<(i64, i64)>> {
    let mut places = std::collections::HashMap::with_capacity(ring.len());
    let mut open: Vec<(i64, i64)> = Vec::new();
    let mut rings = Vec::new();
    for at in ring {
        if let Some(start) = places.get(&at).copied() {
            let part: Vec<(i64, i64)> = open.drain(start..).collect();
            for at in &part {
                places.remove(at);
            }
            rings.push(part);
        }
        places.insert(at, open.len());
        open.push(at);
    }
    rings.push(open);
    rings
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contour::line::twice_area;
    use crate::grid::Window;
    use crate::hydrology::direction::hashed;
    use std::collections::HashMap;

    fn area(parts: &[Vec<Path>]) -> f64 {
        parts.iter().flatten().map(|ring| twice_area(ring) / 2.0).sum()
    }

    #[test]
    fn areas_tile_the_grid_and_share_their_borders() {
        for (rounds, kinds) in [(0, 4), (1, 4), (2, 2), (1, 40)] {
            let window = Window::new(40, 30, 1.0).at(7, -3);
            let mut labels = Grid::filled(window, 0u32);
            for (k, label) in labels.data_mut().iter_mut().enumerate() {
                *label = 1 + hashed((k % 40) as i64 / 2, (k / 40) as i64 / 3) % kinds;
            }
            let found = outlines(&labels, kinds as usize, rounds);
            let all: f64 = found.iter().map(|parts| area(parts)).sum();
            assert!((all - 1200.0).abs() < 1e-9, "{all}");
            // Each border segment belongs to two areas, once in each direction, or to one area and the rim.
            let mut edges: HashMap<[[u64; 2]; 2], i32> = HashMap::new();
            for ring in found.iter().flatten().flatten() {
                assert_eq!(ring.first(), ring.last());
                for pair in ring.windows(2) {
                    let [a, b] = [pair[0], pair[1]].map(|at| at.map(f64::to_bits));
                    *edges.entry(if a < b { [a, b] } else { [b, a] }).or_default() += if a < b { 1 } else { -1 };
                }
            }
            for (edge, sum) in edges.into_iter().filter(|(_, sum)| *sum != 0) {
                let [[ax, ay], [bx, by]] = edge.map(|at| at.map(f64::from_bits));
                let rim = ax == bx && [6.5, 46.5].contains(&ax) || ay == by && [-3.5, 26.5].contains(&ay);
                assert!(rim && sum.abs() == 1, "{:?}", [[ax, ay], [bx, by]]);
            }
            if rounds == 0 {
                for (k, parts) in found.iter().enumerate() {
                    let count = labels.data().iter().filter(|label| **label == k as u32 + 1).count();
                    assert_eq!(area(parts), count as f64);
                }
            }
        }
    }

    #[test]
    fn islands_are_holes_and_squares_that_touch_at_corners_are_parts() {
        let picture = ["111111", "101011", "110111", "111111", "000002"];
        let data: Vec<u32> = picture.iter().flat_map(|row| row.bytes().map(|byte| u32::from(byte - b'0'))).collect();
        let labels = Grid::from_data(Window::new(6, 5, 1.0), data).unwrap();
        let found = outlines(&labels, 2, 0);
        // The three zeros touch at corners only: each is a hole.
        assert_eq!(found[0].len(), 1);
        assert_eq!(found[0][0].len(), 4);
        assert_eq!(found[1], [vec![vec![[5.5, 3.5], [4.5, 3.5], [4.5, 4.5], [5.5, 4.5], [5.5, 3.5]]]]);
        for ring in found[0][0].iter() {
            let mut points = ring[1..].to_vec();
            points.sort_by(|a, b| a.partial_cmp(b).unwrap());
            points.dedup();
            assert_eq!(points.len(), ring.len() - 1, "a ring that touches itself");
        }
    }
}
