//! Drainage: flow directions, drainage areas, watersheds and stream order.

use super::routing::{self, Flats, Planes, step, then};
use super::terrain::{Terrain, TiledTerrain, cells_of, layer_of, sea_level_of};
use crate::budget::memory;
use crate::declare::{Declared, Input};
use crate::large::areas::Layers;
use crate::lower::{Lowering, Passes};
use crate::op::{Context, Solution, Solver, Sources, WorldParams};
use orogen_grid::error::Result;
use orogen_grid::grid::Window;
use orogen_grid::hydrology::accumulation::accumulate_rain_with;
use orogen_grid::hydrology::steepest::Descent;
use orogen_grid::hydrology::{drainage, fill, strahler, watersheds};

choice! {
    /// Flow routing through depressions.
    pub enum DepressionRouting {
        /// Carving: flow crosses a depression along its valleys to the pit and from there back up to the spill point
        /// (Cordonnier, Bovy and Braun 2019).
        Bed = "bed",
        /// Filling: flow is routed on the filled ground. On level water it follows two integer gradients, away from
        /// higher ground and towards the outlet (Barnes, Lehman and Mulla 2014); ties are broken by a hash.
        Surface = "surface",
    }
}

op! {
    /// Drainage of the source by steepest descent (D8): each cell drains to its steepest lower neighbor (O'Callaghan
    /// and Mark 1984).
    ///
    /// Every cell drains to the sea or to the world's border. Ties are broken by a hash of the cell's position. Areas
    /// are counted in whole cells, so they are exact; with `rain` in 65536ths of a cell. Time and memory grow with the
    /// world, 54 bytes per cell; with less memory available, flow is routed tile by tile on disk (Barnes 2016).
    pub struct Drainage = "drainage", solver, revision 1;
    margin;
    inputs {
        /// The heights.
        source: required,
        /// Factor of the rain, 0.01 to 100: `flow` is the drainage area with the same discharge where the factor is 1,
        /// and `stream` is compared with that. Default: 1.
        rain: optional,
    }
    params {
        /// Flow routing through depressions: carving (`bed`) or filling (`surface`).
        over: DepressionRouting = DepressionRouting::Bed;
        /// Drainage area from which on a cell is a stream, for the layer `strahler`.
        stream: f64 = 1e6, unit "m^2", range 0.0 to 1e15;
        /// Whether cells at or below sea level are outlets.
        sea: bool = true;
        /// Cell size of the solution; 0 uses the world's cell.
        cell: f64 = 0.0, unit "m", range 0.0 to 1e6;
    }
    layers {
        /// Drainage area, including the cell itself; weighted by `rain` if it is given.
        flow: flow, unit "m^2";
        /// Flow direction, clockwise from east (0) to north-east (7); 8 at outlets.
        receiver: label;
        /// Number of the watershed, from 1: all cells that drain to one outlet. 0 in the sea.
        watershed: label;
        /// Strahler order of the stream; 0 outside streams.
        strahler: label;
        /// The heights with filled depressions.
        filled: height, unit "m";
    }
}

impl Solver for Drainage {
    fn cell(&self, world_cell: f64) -> f64 {
        if self.cell > 0.0 { self.cell } else { world_cell }
    }

    fn rasters(&self) -> usize {
        6 + usize::from(self.has_rain())
    }

    fn scratch(&self, padded: &Window) -> u64 {
        // In memory there is one raster less than on disk.
        memory(padded, if self.has_rain() { 40 } else { 30 })
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
        let [bed, surface, counting, naming] = context.progress.parts([3.0, 1.0, 1.0, 2.0]);
        let drained = land.route(&bed)?;
        let Terrain { heights, outlets } = land;
        let filled = fill::filled(&heights, &drained.basins);
        drop(heights);
        context.progress.check()?;
        let receivers = match self.over {
            DepressionRouting::Bed => drained.receivers,
            DepressionRouting::Surface => drainage::over_surface_with(&filled, &outlets, Descent::Steepest, &surface)?,
        };
        let filled = sources.keep(filled)?;
        surface.finish();
        let rain = sources.given("rain").then(|| sources.whole("rain", sources.padded())).transpose()?;
        let accumulation = accumulate_rain_with(&receivers, rain.as_ref(), &counting)?;
        drop(rain);
        counting.finish();
        context.progress.check()?;
        let threshold = cells_of(self.stream, receivers.window(), 0);
        let flow = accumulation.areas();
        let [labelling, ordering] = naming.parts([1.0, 1.0]);
        let watersheds = watersheds::watersheds_with(&receivers, &outlets, &accumulation, &labelling)?;
        labelling.finish();
        let orders = strahler::strahler_orders_with(&receivers, &accumulation, threshold, &ordering)?;
        ordering.finish();
        drop(accumulation);
        context.progress.check()?;
        let layers = vec![
            sources.keep(flow)?,
            sources.keep(layer_of(receivers.grid(), f32::from))?,
            sources.keep(layer_of(&watersheds, |n| n as f32))?,
            sources.keep(layer_of(&orders, f32::from))?,
            filled,
        ];
        Ok(Solution { layers, scalars: Vec::new() })
    }

    fn lower(&self, padded: &Window, given: &[bool], world_params: &WorldParams) -> Lowering<Passes> {
        let rain = self.spec().given_input("rain", given);
        let planes = Planes { inputs: 2, layers: self.spec().layers.len(), scratch: SCRATCH, rain };
        if !planes.can_rain(padded) {
            return Lowering::Processor(routing::RAIN);
        }
        let sea_level = sea_level_of(self.sea, world_params);
        let over_bed = if self.over == DepressionRouting::Bed { Flats::Graded } else { Flats::Basins };
        let passes = routing::passes(CODE, padded, sea_level, routing::Descent::Steepest, planes)
            .with_constants([("FILLED", FILLED)])
            .with_numbers([("cell_area", (padded.cell * padded.cell) as f32)])
            .with_named_words([("stream", cells_of(self.stream, padded, 0))]);
        let (passes, turn) = routing::spill(routing::routed(passes, padded, over_bed), padded);
        let mut passes = then(passes, "fill", step(0, 0, turn));
        if self.over == DepressionRouting::Surface {
            let rounds = routing::all_rounds(padded);
            passes = routing::route(passes, padded, rounds, Flats::Graded, step(FILLED, 0, 0));
        }
        let passes = routing::gather(passes, padded);
        let passes = routing::follow(then(passes, "begin_watersheds", 0), padded, "find_pit");
        let orders = 2..=routing::doublings(padded, 2) as u32 + 1;
        let passes = orders.fold(passes, |passes, order| then(passes, "raise_order", step(0, 0, order)));
        Lowering::Shader(then(routing::number(passes), "finish", 0))
    }

    fn cost(&self) -> f64 {
        35.0
    }
}

/// Number of planes of the shaders in addition to inputs, layers, the routing and counters.
const SCRATCH: usize = 3;
/// The plane of the filled heights in the shaders.
const FILLED: u32 = 6;

const CODE: &str = concat!(include_str!("routing.wgsl"), include_str!("numbering.wgsl"), include_str!("drainage.wgsl"));

impl Drainage {
    fn has_rain(&self) -> bool {
        self.rain != Input::None
    }

    /// Solves tile by tile.
    fn solve_on_disk(&self, sources: &dyn Sources, context: &Context) -> Result<Solution> {
        let land = TiledTerrain::read(sources, self.sea, context)?;
        let (mut codes, mut filled) = (sources.raster()?, sources.raster()?);
        land.water(&land.heights, context.progress).route_carving(&mut codes, &mut filled)?;
        let water = land.water(&filled, context.progress);
        if self.over == DepressionRouting::Surface {
            water.over_surface(&mut codes)?;
        }
        let threshold = u64::from(cells_of(self.stream, sources.padded(), 0));
        let [mut flow, mut watershed, mut strahler] = [sources.raster()?, sources.raster()?, sources.raster()?];
        let layers = Layers { flow: &mut flow, watershed: &mut watershed, strahler: &mut strahler, threshold };
        let rain = if sources.given("rain") {
            let mut rain = sources.raster()?;
            sources.each_tile("rain", sources.padded(), &mut |tile| rain.put(tile))?;
            Some(rain)
        } else {
            None
        };
        water.areas(&codes, rain.as_ref(), layers)?;
        Ok(Solution { layers: vec![flow, codes, watershed, strahler, filled], scalars: Vec::new() })
    }
}
