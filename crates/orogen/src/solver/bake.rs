//! Any part of the graph, made once over the world and read ever after.

use crate::error::Result;
use crate::grid::{Grid, Window};
use crate::op::{Context, LayerKind, Slots, Solution, Solver, Sources};
use crate::resample;
use orogen_noise::Points;

op! {
    /// The source made once over the whole world, at a cell of its own, and read between its samples ever after.
    ///
    /// Bake what is dear, what must not change with the resolution asked for (a filter looks different at another cell), or
    /// what would need a halo larger than a tile. Read by the interpolating cubic; on its own lattice a reader gets the sample
    /// itself, bit for bit. Finer detail than the cell is lost.
    pub struct Bake = "bake", solver, revision 1;
    inputs {
        /// What is made once.
        source: required,
    }
    params {
        /// From one baked sample to the next; 0 takes the world's cell.
        cell: f64 = 0.0, unit "m", range 0.0 to 1e6;
    }
}

impl Solver for Bake {
    fn cell(&self, world_cell: f64) -> f64 {
        if self.cell > 0.0 { self.cell } else { world_cell }
    }

    fn memory(&self, padded: &Window) -> u64 {
        padded.len() as u64 * 4
    }

    fn reads_inputs(&self) -> bool {
        false
    }

    fn solve(&self, sources: &dyn Sources, _: &Context) -> Result<Solution> {
        let mut grid = Grid::filled(*sources.padded(), 0.0f32);
        sources.each_tile(0, sources.padded(), &mut |tile| grid.paste(tile))?;
        Ok(Solution { grids: vec![grid], scalars: Vec::new() })
    }

    fn read(&self, solution: &Solution, layer: usize, at: &Points, _: &Slots, out: &mut [f32]) {
        match solution.grids.get(layer) {
            Some(grid) => resample::read(grid, LayerKind::Height, at, out),
            None => out.fill(0.0),
        }
    }
}
