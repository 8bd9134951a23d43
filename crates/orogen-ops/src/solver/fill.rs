//! Depression filling.

use super::routing::{self, Flats, Planes, step, then};
use super::terrain::{Terrain, TiledTerrain, sea_level_of};
use crate::budget::memory;
use crate::declare::Declared;
use crate::lower::{Lowering, Passes};
use crate::op::{Context, Solution, Solver, Sources, WorldParams};
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::hydrology::fill;

op! {
    /// The source with every depression filled to the level of its spill point.
    ///
    /// The result is the lowest surface on which water reaches the sea or the world's border without running uphill. It
    /// equals that of Priority-Flood without an epsilon (Barnes, Lehman and Mulla 2014) bit for bit and is computed by
    /// flooding the graph of basins (Cordonnier, Bovy and Braun 2019). Filled ground is level. Time and memory grow
    /// with the world, 24 bytes per cell; with less memory available, filling works tile by tile on disk (Barnes 2016).
    pub struct Fill = "fill", solver, revision 1;
    margin;
    inputs {
        /// The heights.
        source: required,
    }
    params {
        /// Whether cells at or below sea level are outlets.
        sea: bool = true;
        /// Cell size of the solution; 0 uses the world's cell.
        cell: f64 = 0.0, unit "m", range 0.0 to 1e6;
    }
    layers {
        /// The filled heights.
        filled: height, unit "m";
        /// Depth of the fill above the source.
        depth: height, unit "m";
    }
}

impl Solver for Fill {
    fn cell(&self, world_cell: f64) -> f64 {
        if self.cell > 0.0 { self.cell } else { world_cell }
    }

    fn rasters(&self) -> usize {
        3
    }

    fn scratch(&self, padded: &Window) -> u64 {
        // In memory there is one raster less than on disk.
        memory(padded, 16)
    }

    fn scratch_on_disk(&self, padded: &Window) -> u64 {
        TiledTerrain::memory(padded)
    }

    fn reads_sea_level(&self) -> bool {
        self.sea
    }

    fn solve(&self, sources: &dyn Sources, context: &Context) -> Result<Solution> {
        if sources.on_disk() {
            return self.solve_on_disk(sources, context);
        }
        let land = Terrain::read(sources, self.sea, context)?;
        let drained = land.route(context.progress)?;
        let filled = fill::filled(&land.heights, &drained.basins);
        drop(drained);
        let depth = difference(&filled, land.heights);
        Ok(Solution { layers: vec![sources.keep(filled)?, sources.keep(depth)?], scalars: Vec::new() })
    }

    fn lower(&self, padded: &Window, _: &[bool], world_params: &WorldParams) -> Lowering<Passes> {
        let sea_level = sea_level_of(self.sea, world_params);
        let planes = Planes { inputs: 1, layers: self.spec().layers.len(), scratch: 0, rain: None };
        let passes = routing::passes(CODE, padded, sea_level, routing::Descent::Steepest, planes);
        let (passes, turn) = routing::spill(routing::routed(passes, padded, Flats::Basins), padded);
        Lowering::Shader(then(passes, "fill", step(0, 0, turn)))
    }

    fn cost(&self) -> f64 {
        17.0
    }
}

const CODE: &str = concat!(include_str!("routing.wgsl"), include_str!("fill.wgsl"));

impl Fill {
    /// Solves tile by tile.
    fn solve_on_disk(&self, sources: &dyn Sources, context: &Context) -> Result<Solution> {
        let land = TiledTerrain::read(sources, self.sea, context)?;
        let [mut filled, mut codes] = [sources.raster()?, sources.raster()?];
        land.water(&land.heights, context.progress).route_carving(&mut codes, &mut filled)?;
        let TiledTerrain { mut heights, tiling, .. } = land;
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
