//! Lakes: whether their surface is level and their shores hold it.

use super::layers::{Water, neighbours};

/// Surfaces of lakes.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Lakes {
    /// Cells of lakes.
    pub cells: usize,
    /// The greatest difference between the surfaces of two neighbours in lakes, in m.
    pub step: f32,
    /// The greatest height of a surface above a dry neighbour, in m.
    pub above_shore: f32,
}

/// Compares the surface of every lake cell with its neighbours.
pub fn measure(water: &Water) -> Lakes {
    let mut found = Lakes::default();
    let depth = water.lakes.data();
    for cell in (0..depth.len()).filter(|cell| depth[*cell] > 0.0) {
        found.cells += 1;
        for (_, near) in neighbours(water.window(), cell) {
            let above = water.surface(cell) - water.surface(near);
            let greatest = if depth[near] > 0.0 { &mut found.step } else { &mut found.above_shore };
            *greatest = greatest.max(above);
        }
    }
    found
}
