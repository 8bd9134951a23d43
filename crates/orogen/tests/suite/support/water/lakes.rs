//! Lakes: checks whether their surfaces are level and their shores contain them.

use super::layers::neighbors;
use super::network::Network;

/// Number of cells of the river below an outlet that may be next to the lake.
const OUTLET: usize = 3;

/// Statistics of the surfaces of lakes.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Lakes {
    /// Number of cells of lakes.
    pub cells: usize,
    /// The greatest difference between the surfaces of two neighboring lake cells, in m.
    pub step: f32,
    /// The greatest height of a surface above a dry neighbor that is not in the river below the outlet, in m.
    pub above_shore: f32,
}

/// Compares the surface of every lake cell with its neighbors.
pub fn measure(network: &Network) -> Lakes {
    let mut found = Lakes::default();
    let water = network.water;
    let depth = water.lakes.data();
    let mut is_outlet = vec![false; depth.len()];
    for cell in (0..depth.len()).filter(|cell| depth[*cell] > 0.0) {
        let below = std::iter::successors(network.receiver(cell), |to| network.receiver(*to));
        below.take_while(|to| depth[*to] <= 0.0).take(OUTLET).for_each(|to| is_outlet[to] = true);
    }
    for cell in (0..depth.len()).filter(|cell| depth[*cell] > 0.0) {
        found.cells += 1;
        for (_, near) in neighbors(water.window(), cell).filter(|(_, near)| !is_outlet[*near]) {
            let above = water.surface(cell) - water.surface(near);
            let greatest = if depth[near] > 0.0 { &mut found.step } else { &mut found.above_shore };
            *greatest = greatest.max(above);
        }
    }
    found
}
