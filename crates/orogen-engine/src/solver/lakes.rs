//! Lakes in depressions.

use super::terrain::{Terrain, cells_of, layer_of, memory};
use crate::op::{Context, Solution, Solver, Sources};
use orogen_grid::error::Result;
use orogen_grid::grid::Window;
use orogen_grid::hydrology::lakes;

op! {
    /// Depressions of the source filled with water up to their spill point. Small depressions are filled with ground instead.
    ///
    /// Every lake has an outlet that drains, and all other land drains to a lake, the sea or the world's border. Ground in depressions too
    /// small for a lake is raised to a gentle slope of 1 in 10 000 until water runs off. Time and memory grow with the world, 35 bytes per
    /// cell.
    pub struct Lakes = "lakes", solver, revision 1;
    margin;
    inputs {
        /// The heights.
        source: required,
    }
    params {
        /// Minimum area of a lake. A lake always covers at least 4 cells.
        smallest: f64 = 20000.0, unit "m^2", range 0.0 to 1e15;
        /// Whether cells at or below sea level are outlets.
        sea: bool = true;
        /// Cell size of the solution; 0 uses the world's cell.
        cell: f64 = 0.0, unit "m", range 0.0 to 1e6;
    }
    layers {
        /// The ground: unchanged under lakes, raised in depressions too small for a lake.
        height: height, unit "m";
        /// Water depth; 0 on land.
        depth: height, unit "m";
        /// Water surface of lakes, and the ground elsewhere.
        surface: height, unit "m";
        /// Number of the lake, from 1; 0 on land.
        lake: label;
    }
}

impl Solver for Lakes {
    fn cell(&self, world_cell: f64) -> f64 {
        if self.cell > 0.0 { self.cell } else { world_cell }
    }

    fn scratch(&self, padded: &Window) -> u64 {
        memory(padded, 35)
    }

    fn reads_sea_level(&self) -> bool {
        self.sea
    }

    fn solve(&self, sources: &dyn Sources, context: &Context) -> Result<Solution> {
        let land = Terrain::read(sources, self.sea, context)?;
        let [routing, filling] = context.progress.parts([1.0, 3.0]);
        let drainage = land.route(&routing)?;
        let fewest = cells_of(self.smallest, land.heights.window(), 4);
        let found = lakes::lakes_with(&land.heights, &land.outlets, &drainage, fewest, &filling)?;
        context.progress.check()?;
        let mut depth = land.heights;
        for (depth, (surface, bed)) in
            depth.data_mut().iter_mut().zip(found.surface.data().iter().zip(found.bed.data()))
        {
            *depth = surface - bed;
        }
        let labels = layer_of(&found.labels, |label| label as f32);
        let layers = [found.bed, depth, found.surface, labels];
        let layers = layers.into_iter().map(|grid| sources.keep(grid)).collect::<Result<Vec<_>>>()?;
        Ok(Solution { layers, scalars: Vec::new() })
    }

    fn cost(&self) -> f64 {
        100.0
    }
}
