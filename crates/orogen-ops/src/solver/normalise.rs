//! Scales the source to a range of heights over the world.

use crate::lower::{Lowering, Passes};
use crate::op::{Context, Reading, Solution, Solver, Sources, WorldParams};
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::parallel;
use orogen_noise::shader::function::Shader;

op! {
    /// The source scaled linearly so that its minimum over the whole world becomes `low` and its maximum becomes
    /// `high`.
    ///
    /// Minimum and maximum are computed once, on the world's own lattice; all tiles at all resolutions are scaled by
    /// the same two values. A source without relief becomes `low`. Samples that are not finite are ignored.
    pub struct Normalise = "normalise", solver, revision 1;
    margin;
    inputs {
        /// The values to scale.
        source: required,
    }
    params {
        /// Result for the world's minimum.
        low: f64 = 0.0, unit "m", range -1e6 to 1e6;
        /// Result for the world's maximum.
        high: f64 = 1000.0, unit "m", range -1e6 to 1e6;
    }
}

impl Solver for Normalise {
    fn rasters(&self) -> usize {
        0
    }

    fn reads_inputs(&self) -> bool {
        true
    }

    fn solve(&self, sources: &dyn Sources, _: &Context) -> Result<Solution> {
        let mut range = NOTHING;
        sources.each_tile("source", sources.domain(), &mut |tile| {
            range = join(range, range_of(tile));
            Ok(())
        })?;
        let (low, high) = range;
        Ok(Solution { layers: Vec::new(), scalars: vec![f64::from(low), f64::from(high)] })
    }

    fn read(&self, solution: &Solution, asked: &Reading, out: &mut [f32]) -> Result<()> {
        let [from, scale, to] = self.map(solution);
        for (sample, source) in out.iter_mut().zip(asked.inputs.required("source")?) {
            *sample = (source - from) * scale + to;
        }
        Ok(())
    }

    fn lower_read(&self, _: usize, solution: &Solution) -> Lowering<Shader> {
        const CODE: &str = "fn normalise(base: u32, place: Placement, source: f32) -> f32 {
    return (source - number(base, 0u)) * number(base, 1u) + number(base, 2u);
}";
        Lowering::Shader(Shader::new("normalise", CODE, &self.map(solution)))
    }

    fn lower(&self, _: &Window, _: &[bool], _: &WorldParams) -> Lowering<Passes> {
        Lowering::Processor("its solution is two numbers, not a grid")
    }

    fn cost(&self) -> f64 {
        0.2
    }
}

impl Normalise {
    /// The linear map of a solution: the subtrahend, the factor and the offset.
    fn map(&self, solution: &Solution) -> [f32; 3] {
        let [low, high] = [0, 1].map(|i| solution.scalars.get(i).copied().unwrap_or(0.0));
        let relief = high - low;
        let scale = if relief > 0.0 { ((self.high - self.low) / relief) as f32 } else { 0.0 };
        [if relief >= 0.0 { low as f32 } else { 0.0 }, scale, self.low as f32]
    }
}

/// Minimum and maximum of no samples.
const NOTHING: (f32, f32) = (f32::INFINITY, f32::NEG_INFINITY);

fn join(a: (f32, f32), b: (f32, f32)) -> (f32, f32) {
    (a.0.min(b.0), a.1.max(b.1))
}

/// Minimum and maximum of the finite samples. They do not depend on the order of the samples, so the rows may be
/// processed in parallel.
fn range_of(tile: &Grid) -> (f32, f32) {
    const SAMPLES: usize = 1 << 16;
    let range = |samples: &[f32]| {
        let finite = samples.iter().filter(|sample| sample.is_finite());
        finite.fold(NOTHING, |range, sample| join(range, (*sample, *sample)))
    };
    parallel::map(tile.data().chunks(SAMPLES), range).into_iter().fold(NOTHING, join)
}
