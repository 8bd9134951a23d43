//! Depressions cut open.

use crate::error::Result;
use crate::grid::Window;
use crate::hydrology::outlets::Outlets;
use crate::hydrology::steepest::Descent;
use crate::hydrology::{breach, drainage};
use crate::op::{Context, Solution, Solver, Sources};

op! {
    /// The source with every depression drained by a channel cut through its lowest rim, or filled where that would be too deep.
    ///
    /// Channels follow the ground's own valleys from the depression's bottom over its pass (Cordonnier, Bovy and Braun 2019);
    /// what a cut of `deepest` does not drain is filled first (after Lindsay 2016). Water then nowhere runs uphill; channels'
    /// beds and filled ground are level. Time and memory grow with the world, 30 bytes a cell.
    pub struct Breach = "breach", solver, revision 1;
    inputs {
        /// The heights.
        source: required,
    }
    params {
        /// The deepest cut; 0 only fills.
        deepest: f64 = 50.0, unit "m", range 0.0 to 1e6;
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
        padded.len() as u64 * 30
    }

    fn solve(&self, sources: &dyn Sources, context: &Context) -> Result<Solution> {
        let mut heights = sources.whole(0, sources.padded())?;
        context.progress.check()?;
        let outlets = Outlets::new(&heights, self.sea.then_some(context.setting.sea_level as f32));
        let drainage = drainage::over_bed(&heights, &outlets, Descent::Steepest);
        context.progress.check()?;
        let out = breach::breach(&heights, &outlets, &drainage, self.deepest as f32);
        heights.data_mut().iter_mut().zip(out.data()).for_each(|(change, new)| *change = new - *change);
        Ok(Solution { layers: vec![sources.keep(out)?, sources.keep(heights)?], scalars: Vec::new() })
    }

    fn cost(&self) -> f64 {
        60.0
    }
}
