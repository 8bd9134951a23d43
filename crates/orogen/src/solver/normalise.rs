//! The source stretched to a range of heights over the world.

use crate::error::Result;
use crate::grid::Window;
use crate::op::{Context, Slots, Solution, Solver, Sources};
use orogen_noise::Points;

op! {
    /// The source stretched linearly so that over the whole world its lowest sample becomes `low` and its highest `high`.
    ///
    /// Lowest and highest are taken on the world's own lattice, once; every tile at any resolution is stretched by the same
    /// two numbers. A source without relief becomes `low`. Samples that are not finite are passed over.
    pub struct Normalise = "normalise", solver, revision 1;
    inputs {
        /// What is stretched.
        source: required,
    }
    params {
        /// What the world's lowest sample becomes.
        low: f64 = 0.0, unit "m", range -1e6 to 1e6;
        /// What the world's highest sample becomes.
        high: f64 = 1000.0, unit "m", range -1e6 to 1e6;
    }
}

impl Solver for Normalise {
    fn memory(&self, _: &Window) -> u64 {
        0
    }

    fn reads_inputs(&self) -> bool {
        true
    }

    fn solve(&self, sources: &dyn Sources, _: &Context) -> Result<Solution> {
        // Minimum and maximum do not depend on the order they are taken in.
        let (mut low, mut high) = (f32::INFINITY, f32::NEG_INFINITY);
        sources.each_tile(0, sources.world(), &mut |tile| {
            for sample in tile.data().iter().filter(|sample| sample.is_finite()) {
                low = low.min(*sample);
                high = high.max(*sample);
            }
        })?;
        Ok(Solution { grids: Vec::new(), scalars: vec![f64::from(low), f64::from(high)] })
    }

    fn read(&self, solution: &Solution, _: usize, _: &Points, inputs: &Slots, out: &mut [f32]) {
        let [low, high] = [0, 1].map(|i| solution.scalars.get(i).copied().unwrap_or(0.0));
        let relief = high - low;
        let scale = if relief > 0.0 { ((self.high - self.low) / relief) as f32 } else { 0.0 };
        let (from, to) = (if relief >= 0.0 { low as f32 } else { 0.0 }, self.low as f32);
        for (sample, source) in out.iter_mut().zip(inputs.required(0)) {
            *sample = (source - from) * scale + to;
        }
    }
}
