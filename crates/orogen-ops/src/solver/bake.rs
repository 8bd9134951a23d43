//! Evaluates a part of the graph once over the world and stores it.

use crate::lower::{Lowering, Passes};
use crate::op::{Context, Solution, Solver, Sources, WorldParams};
use orogen_grid::error::Result;
use orogen_grid::grid::Window;

op! {
    /// The source, evaluated once over the whole world at a fixed cell size and stored. Readers interpolate between the
    /// stored samples.
    ///
    /// Bake what is expensive, what must not change with the requested resolution (a filter gives different results at
    /// different cell sizes), or what would need a halo larger than a tile. Values between samples are interpolated as
    /// the source's layer is (heights by a cubic). At the samples themselves readers get the stored values bit for bit.
    /// Detail finer than the cell is lost. `resample` computes only what a window needs, also in unbounded worlds.
    pub struct Bake = "bake", solver, revision 1;
    margin;
    inputs {
        /// The values to store.
        source: required,
    }
    params {
        /// Cell size of the stored samples; 0 uses the world's cell.
        cell: f64 = 0.0, unit "m", range 0.0 to 1e6;
    }
    layers {
        /// The stored source.
        baked: source;
    }
}

impl Solver for Bake {
    fn cell(&self, world_cell: f64) -> f64 {
        if self.cell > 0.0 { self.cell } else { world_cell }
    }

    fn solve(&self, sources: &dyn Sources, _: &Context) -> Result<Solution> {
        let mut baked = sources.raster()?;
        sources.each_tile("source", sources.padded(), &mut |tile| baked.put(tile))?;
        Ok(Solution { layers: vec![baked], scalars: Vec::new() })
    }

    fn lower(&self, _: &Window, _: &[bool], _: &WorldParams) -> Lowering<Passes> {
        Lowering::Processor("it stores the samples of its source and computes nothing")
    }

    fn cost(&self) -> f64 {
        0.3
    }
}
