//! Depressions cut open.

use crate::error::Result;
use crate::grid::Window;
use crate::hydrology::least_cost::{self, Limits};
use crate::hydrology::outlets::Outlets;
use crate::hydrology::steepest::Descent;
use crate::hydrology::{breach, drainage};
use crate::op::{Context, Solution, Solver, Sources};

choice! {
    /// Where channels are cut.
    pub enum Way {
        /// Along the ground's own valleys, from the depression's bottom over its lowest rim (Cordonnier, Bovy and Braun 2019).
        Valley = "valley",
        /// Wherever it takes the least digging to come to lower ground: through a thin dam rather than around it (Lindsay 2016).
        LeastCost = "least-cost",
    }
}

op! {
    /// The source with every depression drained by a channel cut through its lowest rim, or filled where that would be too deep.
    ///
    /// Channels follow the ground's own valleys from the depression's bottom over its pass (Cordonnier, Bovy and Braun 2019), or go where it
    /// takes the least digging (Lindsay 2016). What they would have to cut more than `deepest` for is filled first (`way = "valley"`) or filled
    /// to the brim (`"least-cost"`). Water then nowhere runs uphill; channels' beds and filled ground are level. Time and memory grow with
    /// the world, 30 bytes a cell along valleys and 60 at least cost.
    pub struct Breach = "breach", solver, revision 1;
    inputs {
        /// The heights.
        source: required,
    }
    params {
        /// The deepest cut; 0 only fills.
        deepest: f64 = 50.0, unit "m", range 0.0 to 1e6;
        /// Where channels are cut.
        way: Way = Way::Valley;
        /// The longest channel of least cost.
        longest: f64 = 3000.0, unit "m", range 0.0 to 1e6;
        /// Whether water also leaves where the ground is at or below sea level.
        sea: bool = true;
    }
    layers {
        /// The drained heights.
        height: height, unit "m";
        /// How much higher the ground is than the source: below 0 where it was cut, above where filled.
        change: height, unit "m";
    }
}

impl Solver for Breach {
    fn scratch(&self, padded: &Window) -> u64 {
        let each = match self.way {
            Way::Valley => 30,
            Way::LeastCost => 60,
        };
        padded.len() as u64 * each
    }

    fn reads_sea_level(&self) -> bool {
        self.sea
    }

    fn solve(&self, sources: &dyn Sources, context: &Context) -> Result<Solution> {
        let mut heights = sources.whole(0, sources.padded())?;
        context.progress.check()?;
        let outlets = Outlets::new(&heights, self.sea.then_some(context.world_params.sea_level as f32));
        let deepest = self.deepest as f32;
        let out = match self.way {
            Way::Valley => {
                let drainage = drainage::over_bed_with(&heights, &outlets, Descent::Steepest, context.progress)?;
                breach::breach(&heights, &outlets, &drainage, deepest)
            }
            Way::LeastCost => {
                let longest = (self.longest / heights.window().cell).min(f64::from(u32::MAX)) as u32;
                least_cost::breach(&heights, &outlets, &Limits { deepest, longest }, context.progress)?
            }
        };
        heights.data_mut().iter_mut().zip(out.data()).for_each(|(change, new)| *change = new - *change);
        Ok(Solution { layers: vec![sources.keep(out)?, sources.keep(heights)?], scalars: Vec::new() })
    }

    fn cost(&self) -> f64 {
        60.0
    }
}
