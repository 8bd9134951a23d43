//! What the parts of a map are converted with: its scale and its cells.

use super::cells::Cells;
use super::parts::Water;

/// What the parts of a map are converted with.
pub struct Surroundings {
    pub metres_per_pixel: f64,
    pub size: [f64; 2],
    pub spacing: f64,
    pub cells: Cells,
    /// The water of each cell.
    pub water: Vec<Option<Water>>,
}

impl Surroundings {
    /// A position within the map, or on its border if it is outside.
    pub fn limited(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [x.clamp(0.0, self.size[0]), y.clamp(0.0, self.size[1])]
    }

    /// The nearest position on the border of the map.
    pub fn edge(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [width, height] = self.size;
        let sides = [(x, [0.0, y]), (width - x, [width, y]), (y, [x, 0.0]), (height - y, [x, height])];
        sides.into_iter().min_by(|a, b| a.0.total_cmp(&b.0)).map_or([x, y], |side| side.1)
    }

    /// Where the line between two neighboring cells crosses their common side, or the middle of that side.
    pub fn shore(&self, from: usize, to: usize) -> Option<[f64; 2]> {
        let (one, other) = (self.cells.around(from), self.cells.around(to));
        let mut common = one.iter().filter(|vertex| other.contains(vertex));
        let (a, b) = (common.next()?, common.next()?);
        let [a, b] = [*a, *b].map(|vertex| self.cells.vertices[vertex as usize]);
        let (p, q) = (*self.cells.middles.get(from)?, *self.cells.middles.get(to)?);
        let cross = |u: [f64; 2], v: [f64; 2]| u[0] * v[1] - u[1] * v[0];
        let along = [b[0] - a[0], b[1] - a[1]];
        let across = [q[0] - p[0], q[1] - p[1]];
        let share = cross([p[0] - a[0], p[1] - a[1]], across) / cross(along, across);
        let share = if (0.0..=1.0).contains(&share) { share } else { 0.5 };
        Some([a[0] + share * along[0], a[1] + share * along[1]])
    }
}
