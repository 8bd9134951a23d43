//! Lakes in depressions.

use super::routing::{self, Flats, Planes, step, then};
use super::terrain::{Terrain, cells_of, layer_of, sea_level_of};
use crate::budget::memory;
use crate::declare::Declared;
use crate::lower::{Lowering, Passes};
use crate::op::{Context, Solution, Solver, Sources, WorldParams};
use orogen_grid::error::Result;
use orogen_grid::grid::Window;
use orogen_grid::hydrology::lakes;

op! {
    /// Depressions of the source filled with water up to their spill point. Small depressions are filled with ground
    /// instead.
    ///
    /// Every lake has an outlet that drains, and all other land drains to a lake, the sea or the world's border. Ground
    /// in depressions too small for a lake is raised to a gentle slope of 1 in 10 000 until water runs off. Time and
    /// memory grow with the world, 35 bytes per cell.
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
        let fewest = cells_of(self.smallest, land.heights.window(), MIN_CELLS);
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

    fn lower(&self, padded: &Window, _: &[bool], world_params: &WorldParams) -> Lowering<Passes> {
        let rise = (padded.cell * lakes::MIN_SLOPE) as f32;
        let sea_level = sea_level_of(self.sea, world_params);
        let planes = Planes { inputs: 1, layers: self.spec().layers.len(), scratch: SCRATCH, rain: None };
        let passes = routing::passes(CODE, padded, sea_level, routing::Descent::Steepest, planes)
            .with_constants([("SURFACES", SURFACES)])
            .with_named_words([("smallest", cells_of(self.smallest, padded, MIN_CELLS))])
            .with_numbers([("rise_of_cell", rise)]);
        let (passes, turn) = routing::spill(routing::routed(passes, padded, Flats::Graded), padded);
        let passes = then(passes, "begin_lakes", step(0, 0, turn));
        let passes = routing::follow(passes, padded, "find_lake");
        let functions = ["count_cells", "find_deepest", "find_outflow", "begin_surface"];
        let passes = functions.into_iter().fold(passes, |passes, name| then(passes, name, step(0, 0, turn)));
        let compositions = routing::following(padded) as u32;
        let compose = |passes, k| then(passes, "compose_surface", step(0, 0, k % 2));
        let passes = routing::number((0..compositions).fold(passes, compose));
        let surface = SURFACES + 3 * (compositions % 2) + 1;
        Lowering::Shader(then(passes, "finish", step(0, surface, turn)))
    }

    fn cost(&self) -> f64 {
        100.0
    }
}

const CODE: &str = concat!(include_str!("routing.wgsl"), include_str!("numbering.wgsl"), include_str!("lakes.wgsl"));

/// Number of planes of the shaders in addition to inputs, layers, the routing and counters.
const SCRATCH: usize = 16;

/// The first plane of the surface functions in the shaders.
const SURFACES: u32 = 23;

/// Minimum number of cells of a lake.
const MIN_CELLS: u32 = 4;
