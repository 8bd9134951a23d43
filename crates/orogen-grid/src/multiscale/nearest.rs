//! The node nearest to a lattice point, and the path from node to node.

use super::level::Level;
use super::refinement::Refinement;
use crate::hydrology::direction::{NONE, STEPS};

impl Refinement {
    /// The node that is nearest to the point at `share` of the sides of cell `q`, where `share` is as in
    /// [`Refinement::surface_at`]. On the finest level of valleys it is the node of the cell.
    pub(super) fn nearest_node(&self, share: f32, level: &Level, q: usize) -> usize {
        if self.is_finest(level.depth) {
            return q;
        }
        let width = level.window.width;
        let inside = self.inside(level.depth, share);
        let mut nearest = (f32::INFINITY, q);
        for (row, south) in (0..4).map(|row| (q + row * width - 2 * width - 2, row as f32 - 2.0)) {
            for (o, east) in (0..4).map(|column| (row + column, column as f32 - 2.0)) {
                let (x, y) = (level.east[o] + east - inside, level.south[o] + south - inside);
                let square = x * x + y * y;
                if square < nearest.0 {
                    nearest = (square, o);
                }
            }
        }
        nearest.1
    }

    /// Number of cells of a level in a distance in metres, from 2 to `most`.
    pub(super) fn cells_in(&self, depth: usize, metres: f64, most: usize) -> usize {
        ((metres / self.cell_of(depth)).ceil() as usize).clamp(2, most)
    }
}

impl Level {
    /// Whether a node is standing water.
    pub(super) fn is_water(&self, q: usize) -> bool {
        self.receiver[q] >= NONE
    }

    /// The node that a node drains to; `None` in water and at the edge of the window.
    pub(super) fn downstream(&self, q: usize) -> Option<usize> {
        self.neighbor(q, *STEPS.get(usize::from(self.receiver[q]))?)
    }

    /// The node of the cell that is the given number of columns to the east and rows to the south.
    pub(super) fn neighbor(&self, q: usize, (east, south): (isize, isize)) -> Option<usize> {
        let (width, height) = (self.window.width, self.window.height);
        let (x, y) = ((q % width).checked_add_signed(east)?, (q / width).checked_add_signed(south)?);
        (x < width && y < height).then_some(y * width + x)
    }
}
