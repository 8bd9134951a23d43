//! Height above nearest drainage and distance to streams.

use super::routing::{self, Flats, Planes, step, then};
use super::terrain::{Terrain, cells_of, layer_of, sea_level_of};
use crate::budget::memory;
use crate::declare::Declared;
use crate::lower::{Lowering, Passes};
use crate::op::{Context, Solution, Solver, Sources, WorldParams};
use orogen_grid::analysis::distance::nearest_in_whole;
use orogen_grid::error::Result;
use orogen_grid::grid::Window;
use orogen_grid::hydrology::above_drainage::above_drainage_with;
use orogen_grid::hydrology::accumulation::accumulate_with;
use orogen_grid::hydrology::fill;

op! {
    /// Height above nearest drainage (HAND), and the distance to the nearest stream along the flow and in a straight
    /// line.
    ///
    /// Flow is routed as in `drainage` (D8, carving through depressions). Streams are the cells with a drainage area of
    /// at least `stream`. The height is that of the filled source minus that of the first stream cell downstream (Rennó
    /// and others 2008, Nobre and others 2011), so it is never negative. Ground that reaches the sea or the world's
    /// border before a stream is measured down to that outlet. Time and memory grow with the world, 56 bytes per cell.
    pub struct HeightAboveDrainage = "height-above-drainage", solver, revision 1;
    margin;
    inputs {
        /// The heights.
        source: required,
    }
    params {
        /// Drainage area from which on a cell is a stream.
        stream: f64 = 1e6, unit "m^2", range 0.0 to 1e15;
        /// Whether cells at or below sea level are outlets.
        sea: bool = true;
    }
    layers {
        /// Height above the stream that the ground drains to; 0 in streams.
        height: height, unit "m";
        /// Length of the flow path to that stream, with diagonal steps counted as the square root of 2 cells; 0 in
        /// streams.
        flow_distance: height, unit "m";
        /// Straight-line distance to the nearest stream. In a world without streams it is the length of the world's
        /// diagonal.
        distance: height, unit "m";
    }
}

impl Solver for HeightAboveDrainage {
    fn scratch(&self, padded: &Window) -> u64 {
        memory(padded, 56)
    }

    fn reads_sea_level(&self) -> bool {
        self.sea
    }

    fn solve(&self, sources: &dyn Sources, context: &Context) -> Result<Solution> {
        let land = Terrain::read(sources, self.sea, context)?;
        let window = *land.heights.window();
        let [routing, counting, following, nearing] = context.progress.parts([4.0, 1.0, 1.0, 2.0]);
        let drained = land.route(&routing)?;
        let filled = fill::filled(&land.heights, &drained.basins);
        drop(land);
        let receivers = drained.receivers;
        context.progress.check()?;
        let areas = accumulate_with(&receivers, &counting)?;
        counting.finish();
        context.progress.check()?;
        let threshold = cells_of(self.stream, &window, 1);
        let found = above_drainage_with(filled, &receivers, &areas, threshold, &following)?;
        let layers = [sources.keep(found.height)?, sources.keep(found.distance)?];
        following.finish();
        context.progress.check()?;
        let streams = layer_of(&areas.area, |area| f32::from(u8::from(area >= threshold)));
        drop((areas, receivers));
        let mut distance = nearest_in_whole(&streams, 1.0, &nearing)?;
        context.progress.check()?;
        let (across, down) = (window.width as f64, window.height as f64);
        let diagonal = (across * across + down * down).sqrt();
        for samples in distance.data_mut() {
            *samples = (f64::from(*samples).min(diagonal) * window.cell) as f32;
        }
        nearing.finish();
        Ok(Solution { layers: layers.into_iter().chain([sources.keep(distance)?]).collect(), scalars: Vec::new() })
    }

    fn lower(&self, padded: &Window, _: &[bool], world_params: &WorldParams) -> Lowering<Passes> {
        let planes = Planes { inputs: 1, layers: self.spec().layers.len(), scratch: SCRATCH, rain: None };
        let sea_level = sea_level_of(self.sea, world_params);
        let passes = routing::passes(CODE, padded, sea_level, routing::Descent::Steepest, planes)
            .with_named_words([("stream", cells_of(self.stream, padded, 1))])
            .with_numbers([("cell_length", padded.cell as f32)]);
        let (passes, turn) = routing::spill(routing::routed(passes, padded, Flats::Graded), padded);
        let passes = routing::gather(then(passes, "fill", step(0, 0, turn)), padded);
        let turns = routing::following(padded) as u32;
        let follow = |passes, k| then(passes, "follow_paths", step(0, 0, k % 2));
        let passes = (0..turns).fold(then(passes, "begin_paths", 0), follow);
        let passes = then(then(passes, "scan_columns", 0), "finish", step(0, 0, turns % 2));
        Lowering::Shader(passes.reading(padded.width))
    }

    fn cost(&self) -> f64 {
        80.0
    }
}

const CODE: &str = concat!(include_str!("routing.wgsl"), include_str!("height_above_drainage.wgsl"));

/// Number of planes of the shaders in addition to inputs, layers, the routing and counters.
const SCRATCH: usize = 6;
