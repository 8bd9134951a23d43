//! Depression breaching.

use super::terrain::Terrain;
use crate::budget::memory;
use crate::lower::{Lowering, Passes};
use crate::op::{Context, Solution, Solver, Sources, WorldParams};
use orogen_grid::error::Result;
use orogen_grid::grid::Window;
use orogen_grid::hydrology::breach;
use orogen_grid::hydrology::least_cost::{self, Limits};

choice! {
    /// Route of the breach channels.
    pub enum BreachRoute {
        /// Along the valleys of the ground, from the bottom of the depression over its lowest spill point (Cordonnier,
        /// Bovy and Braun 2019).
        Valley = "valley",
        /// Along the path with the least excavation to lower ground, for example through a thin dam rather than around
        /// it (Lindsay 2016).
        LeastCost = "least-cost",
    }
}

op! {
    /// The source with every depression drained by a channel cut through its rim, or filled where the channel would be
    /// too deep.
    ///
    /// Channels follow the valleys of the ground from the bottom of the depression over its spill point (Cordonnier,
    /// Bovy and Braun 2019), or the path of least excavation (Lindsay 2016). Where the cut would be deeper than
    /// `deepest`, the depression is first filled as far as necessary (`way = "valley"`) or filled completely
    /// (`"least-cost"`). In the result water never runs uphill; channel beds and filled ground are level. Time and
    /// memory grow with the world: 30 bytes per cell for `"valley"`, 60 for `"least-cost"`.
    pub struct Breach = "breach", solver, revision 1;
    margin;
    inputs {
        /// The heights.
        source: required,
    }
    params {
        /// Maximum depth of a cut. 0 only fills.
        deepest: f64 = 50.0, unit "m", range 0.0 to 1e6;
        /// Route of the breach channels.
        way: BreachRoute = BreachRoute::Valley;
        /// Maximum length of a channel with `way = "least-cost"`.
        longest: f64 = 3000.0, unit "m", range 0.0 to 1e6;
        /// Whether cells at or below sea level are outlets.
        sea: bool = true;
        /// Cell size of the solution; 0 uses the world's cell.
        cell: f64 = 0.0, unit "m", range 0.0 to 1e6;
    }
    layers {
        /// The heights without depressions.
        height: height, unit "m";
        /// Height difference to the source: negative where the ground was cut, positive where it was filled.
        change: height, unit "m";
    }
}

impl Solver for Breach {
    fn cell(&self, world_cell: f64) -> f64 {
        if self.cell > 0.0 { self.cell } else { world_cell }
    }

    fn scratch(&self, padded: &Window) -> u64 {
        let each = match self.way {
            BreachRoute::Valley => 30,
            BreachRoute::LeastCost => 60,
        };
        memory(padded, each)
    }

    fn reads_sea_level(&self) -> bool {
        self.sea
    }

    fn solve(&self, sources: &dyn Sources, context: &Context) -> Result<Solution> {
        let land = Terrain::read(sources, self.sea, context)?;
        let deepest = self.deepest as f32;
        let out = match self.way {
            BreachRoute::Valley => {
                let [routing, cutting] = context.progress.parts([2.0, 1.0]);
                let drainage = land.route(&routing)?;
                breach::breach_with(&land.heights, &land.outlets, &drainage, deepest, &cutting)?
            }
            BreachRoute::LeastCost => {
                let longest = (self.longest / land.heights.window().cell).min(f64::from(u32::MAX)) as u32;
                least_cost::breach(&land.heights, &land.outlets, &Limits::new(deepest, longest), context.progress)?
            }
        };
        let mut change = land.heights;
        change.data_mut().iter_mut().zip(out.data()).for_each(|(change, new)| *change = new - *change);
        Ok(Solution { layers: vec![sources.keep(out)?, sources.keep(change)?], scalars: Vec::new() })
    }

    fn lower(&self, _: &Window, _: &[bool], _: &WorldParams) -> Lowering<Passes> {
        Lowering::Processor("channels are dug one after the other")
    }

    fn cost(&self) -> f64 {
        60.0
    }
}
