//! The samples that solvers cover: the world, or a wider domain, on a lattice.

use orogen_grid::grid::Window;
use orogen_ops::op::{Solver, WorldParams, whole_cells, world_window};

/// Samples beyond a world's or a domain's edge that readers may need.
pub const WORLD_MARGIN: usize = 2;

/// The samples that a solver covers, on its own lattice.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Domain {
    /// The world and the solver's margin beyond each side.
    pub window: Window,
    /// The same with the samples beyond the edge that readers may need.
    pub padded: Window,
}

impl Domain {
    /// The domain of a solver. In a world without a size, which has no solvers, it is a single cell.
    #[must_use]
    pub fn of(solver: &dyn Solver, world: &WorldParams) -> Domain {
        let cell = solver.cell(world.cell);
        let (window, _) = world_windows(world.size.unwrap_or([cell, cell]), cell);
        // A part of a cell counts as a cell: the domain covers all of the margin.
        let margin = whole_cells(solver.margin().unwrap_or(0.0), cell, f64::ceil);
        let window = window.grown(margin);
        Domain { window, padded: window.grown(WORLD_MARGIN) }
    }
}

/// The samples of a world on a lattice, without and with the margin for readers.
#[must_use]
pub fn world_windows(size: [f64; 2], cell: f64) -> (Window, Window) {
    let world = world_window(size, cell);
    (world, world.grown(WORLD_MARGIN))
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_ops::solver::Fill;

    #[test]
    fn domains_cover_the_world_and_its_margin() {
        let world = WorldParams { seed: 0, size: Some([1000.0, 505.0]), cell: 10.0, sea_level: 0.0 };
        let domain = |margin: f64| Domain::of(&Fill { margin, ..Fill::default() }, &world);
        assert_eq!(domain(0.0).window, Window::new(101, 51, 10.0));
        assert_eq!(domain(0.0).padded, Window::new(105, 55, 10.0).at(-2, -2));
        assert_eq!(domain(30.0).window, Window::new(107, 57, 10.0).at(-3, -3));
        assert_eq!(domain(30.0).padded, Window::new(111, 61, 10.0).at(-5, -5));
        // A fraction of a cell, and a whole number of cells whose division is not exact.
        assert_eq!(domain(30.1).window, Window::new(109, 59, 10.0).at(-4, -4));
        let fine = WorldParams { cell: 0.1, ..world };
        let fine = Domain::of(&Fill { margin: 0.3, ..Fill::default() }, &fine);
        assert_eq!((fine.window.x, fine.window.width), (-3, 10_007));
    }
}
