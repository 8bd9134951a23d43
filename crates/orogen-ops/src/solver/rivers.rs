//! Rivers and their beds.

use super::terrain::{Terrain, cells_of, layer, layer_of};
use crate::budget::memory;
use crate::lower::{Lowering, Passes};
use crate::op::{Context, Solution, Solver, Sources, WorldParams};
use orogen_grid::error::Result;
use orogen_grid::grid::Window;
use orogen_grid::hydrology::accumulation::accumulate_with;
use orogen_grid::hydrology::rivers::{Channel, carve_with};
use orogen_grid::hydrology::{breach, strahler};

op! {
    /// Rivers where the drainage area is large enough, with beds cut into the source that descend all the way
    /// downstream.
    ///
    /// Depressions are drained first, as by `breach`. A river with discharge Q (m^3/s) is `width` Q^0.5 metres wide and
    /// `depth` Q^0.4 metres deep (Leopold and Maddock 1953). Its bed is cut by that depth into the cells that it
    /// crosses, whatever its width. Time and memory grow with the world, 40 bytes per cell.
    pub struct Rivers = "rivers", solver, revision 1;
    margin;
    inputs {
        /// The heights.
        source: required,
    }
    params {
        /// Drainage area from which on a cell is a river.
        stream: f64 = 5e6, unit "m^2", range 0.0 to 1e15;
        /// Runoff from the ground.
        runoff: f64 = 0.5, unit "m/yr", range 0.0 to 1000.0;
        /// Width of a river of 1 m^3/s.
        width: f64 = 5.0, unit "m", range 0.0 to 1000.0;
        /// Depth of a river of 1 m^3/s.
        depth: f64 = 0.3, unit "m", range 0.0 to 1000.0;
        /// Maximum depth of a cut through the rim of a depression. Deeper depressions are filled first.
        deepest: f64 = 50.0, unit "m", range 0.0 to 1e6;
        /// Whether cells at or below sea level are outlets.
        sea: bool = true;
        /// Cell size of the solution; 0 uses the world's cell.
        cell: f64 = 0.0, unit "m", range 0.0 to 1e6;
    }
    layers {
        /// The ground with river beds.
        height: height, unit "m";
        /// Drainage area.
        flow: flow, unit "m^2";
        /// Width of the river; 0 outside rivers.
        width: label, unit "m";
        /// Strahler order of the river; 0 outside rivers.
        strahler: label;
    }
}

impl Solver for Rivers {
    fn cell(&self, world_cell: f64) -> f64 {
        if self.cell > 0.0 { self.cell } else { world_cell }
    }

    fn scratch(&self, padded: &Window) -> u64 {
        memory(padded, 40)
    }

    fn reads_sea_level(&self) -> bool {
        self.sea
    }

    fn solve(&self, sources: &dyn Sources, context: &Context) -> Result<Solution> {
        let land = Terrain::read(sources, self.sea, context)?;
        let window = *land.heights.window();
        let [routing, breaching, counting, carving] = context.progress.parts([2.0, 1.0, 1.0, 2.0]);
        let drainage = land.route(&routing)?;
        let mut ground = breach::breach_with(&land.heights, &land.outlets, &drainage, self.deepest as f32, &breaching)?;
        drop(land);
        breaching.finish();
        context.progress.check()?;
        let drained = accumulate_with(&drainage.receivers, &counting)?;
        counting.finish();
        context.progress.check()?;
        let cell_area = window.cell * window.cell;
        let threshold = cells_of(self.stream, &window, 1);
        let [ordering, carving] = carving.parts([1.0, 1.0]);
        let orders = strahler::strahler_orders_with(&drainage.receivers, &drained, threshold, &ordering)?;
        ordering.finish();
        let channel = Channel::default().with_runoff(self.runoff).with_width(self.width).with_depth(self.depth);
        context.progress.check()?;
        carve_with(&mut ground, &drainage.receivers, &drained, &orders, &channel, &carving)?;
        carving.finish();
        context.progress.check()?;
        let area = |c: usize| f64::from(drained.area.data()[c]) * cell_area;
        let wide = |c: usize| if orders.data()[c] > 0 { channel.width_of(channel.discharge(area(c))) } else { 0.0 };
        let mut layers = vec![sources.keep(ground)?];
        layers.push(sources.keep(layer(window, |c| area(c) as f32))?);
        context.progress.check()?;
        layers.push(sources.keep(layer(window, |c| wide(c) as f32))?);
        context.progress.check()?;
        layers.push(sources.keep(layer_of(&orders, f32::from))?);
        Ok(Solution { layers, scalars: Vec::new() })
    }

    fn lower(&self, _: &Window, _: &[bool], _: &WorldParams) -> Lowering<Passes> {
        Lowering::Processor("beds are cut in f64 from the sources downstream")
    }

    fn cost(&self) -> f64 {
        100.0
    }
}
