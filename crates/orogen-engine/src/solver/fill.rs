//! Depression filling.

use crate::large::drainage::{self as large, Water};
use crate::large::tiling::Tiling;
use crate::op::{Context, Solution, Solver, Sources};
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::hydrology::outlets::Outlets;
use orogen_grid::hydrology::steepest::Descent;
use orogen_grid::hydrology::{drainage, fill};

op! {
    /// The source with every depression filled to the level of its spill point.
    ///
    /// The result is the lowest surface on which water reaches the sea or the world's border without running uphill. It equals that of
    /// Priority-Flood without an epsilon (Barnes, Lehman and Mulla 2014) bit for bit and is computed by flooding the graph of basins
    /// (Cordonnier, Bovy and Braun 2019). Filled ground is level. Time and memory grow with the world, 24 bytes per cell; with less memory
    /// available, filling works tile by tile on disk (Barnes 2016).
    pub struct Fill = "fill", solver, revision 1;
    margin;
    inputs {
        /// The heights.
        source: required,
    }
    params {
        /// Whether cells at or below sea level are outlets.
        sea: bool = true;
    }
    layers {
        /// The filled heights.
        filled: height, unit "m";
        /// Depth of the fill above the source.
        depth: height, unit "m";
    }
}

impl Solver for Fill {
    fn rasters(&self) -> usize {
        3
    }

    fn scratch(&self, padded: &Window) -> u64 {
        // In memory there is one raster less than on disk.
        padded.len() as u64 * 16
    }

    fn scratch_on_disk(&self, padded: &Window) -> u64 {
        large::memory(padded.len() as u64)
    }

    fn reads_sea_level(&self) -> bool {
        self.sea
    }

    fn solve(&self, sources: &dyn Sources, context: &Context) -> Result<Solution> {
        if sources.on_disk() {
            return self.solve_on_disk(sources, context);
        }
        let heights = sources.whole(0, sources.padded())?;
        context.progress.check()?;
        let outlets = Outlets::new(&heights, self.sea.then_some(context.world_params.sea_level as f32));
        let drained = drainage::route_carving_with(&heights, &outlets, Descent::Steepest, context.progress)?;
        let filled = fill::filled(&heights, &drained.basins);
        drop(drained);
        let depth = difference(&filled, heights);
        Ok(Solution { layers: vec![sources.keep(filled)?, sources.keep(depth)?], scalars: Vec::new() })
    }

    fn cost(&self) -> f64 {
        17.0
    }
}

impl Fill {
    /// Tile by tile.
    fn solve_on_disk(&self, sources: &dyn Sources, context: &Context) -> Result<Solution> {
        let [mut heights, mut filled, mut codes] = [sources.raster()?, sources.raster()?, sources.raster()?];
        sources.each_tile(0, sources.padded(), &mut |tile| heights.put(tile))?;
        let sea = self.sea.then_some(context.world_params.sea_level as f32);
        let padded = *sources.padded();
        let tiling = Tiling::new(padded, large::side(padded.len() as u64));
        let water = Water { heights: &heights, sea, tiling, progress: context.progress };
        water.route_carving(&mut codes, &mut filled)?;
        for t in 0..tiling.count() {
            heights.put(&difference(&filled.get(&tiling.tile(t))?, heights.get(&tiling.tile(t))?))?;
        }
        Ok(Solution { layers: vec![filled, heights], scalars: Vec::new() })
    }
}

/// `a` minus `b`, in `b`'s memory.
fn difference(a: &Grid, mut b: Grid) -> Grid {
    b.data_mut().iter_mut().zip(a.data()).for_each(|(b, a)| *b = a - *b);
    b
}
