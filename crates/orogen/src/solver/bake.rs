//! Any part of the graph, made once over the world and read ever after.

use crate::error::Result;
use crate::op::{Context, Solution, Solver, Sources};

op! {
    /// The source made once over the whole world, at a cell of its own, and read between its samples ever after.
    ///
    /// Bake what is dear, what must not change with the resolution asked for (a filter looks different at another cell), or
    /// what would need a halo larger than a tile. Read between samples as its source's layer is (heights by the interpolating
    /// cubic); on its own lattice a reader gets the sample itself, bit for bit. Finer detail than the cell is lost.
    pub struct Bake = "bake", solver, revision 1;
    inputs {
        /// What is made once.
        source: required,
    }
    params {
        /// From one baked sample to the next; 0 takes the world's cell.
        cell: f64 = 0.0, unit "m", range 0.0 to 1e6;
    }
    layers {
        /// The source as it was made.
        baked: source;
    }
}

impl Solver for Bake {
    fn cell(&self, world_cell: f64) -> f64 {
        if self.cell > 0.0 { self.cell } else { world_cell }
    }

    fn solve(&self, sources: &dyn Sources, _: &Context) -> Result<Solution> {
        let mut baked = sources.raster()?;
        sources.each_tile(0, sources.padded(), &mut |tile| baked.put(tile))?;
        Ok(Solution { layers: vec![baked], scalars: Vec::new() })
    }

    fn cost(&self) -> f64 {
        0.3
    }
}
