//! Distance to the nearest sample above a threshold.

use crate::budget::memory;
use crate::lower::{Lowering, Passes, alternating};
use crate::op::{Context, Filter, GridInputs, WorldParams, wrong_layers};
use orogen_grid::analysis::distance::nearest_with;
use orogen_grid::analysis::selection::Selection;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};

op! {
    /// The distance to the nearest sample at which the source reaches a threshold, and a mask of its surroundings.
    ///
    /// Use it for the distance to a river (`drainage.flow` above a threshold), a lake, the sea or a mask. Distances
    /// between samples are exact (Meijster, Roerdink and Hesselink 2000) up to `reach`; the halo is `reach`. About 15
    /// ns per sample, for any reach.
    pub struct Distance = "distance", filter, revision 1;
    inputs {
        /// The values to compare with `threshold`.
        source: required,
    }
    params {
        /// Samples with a value of at least this are targets.
        threshold: f64 = 0.5, range -1e18 to 1e18;
        /// Largest distance measured. Samples farther from any target get this distance.
        reach: f64 = 500.0, unit "m", range 0.0 to 1e6;
    }
    layers {
        /// Distance to the nearest target.
        distance: height, unit "m";
        /// 1 at targets, falling smoothly to 0 at the distance `reach`.
        near: height;
    }
}

/// Maximum reach in samples.
const FARTHEST: f64 = 16_384.0;

const CODE: &str = concat!(include_str!("../lower/selection.wgsl"), include_str!("distance.wgsl"));

impl Filter for Distance {
    fn halo(&self, cell: f64) -> usize {
        (self.reach / cell).ceil().min(FARTHEST) as usize
    }

    fn scratch(&self, window: &Window) -> u64 {
        let grown = window.grown(self.halo(window.cell));
        // Distances along the columns, and the result.
        memory(&Window { height: window.height, ..grown }, 4).saturating_add(memory(window, 4))
    }

    fn apply(&self, inputs: &GridInputs, window: &Window, out: &mut [Option<Grid>], context: &Context) -> Result<()> {
        let source = inputs.required("source")?;
        let [distance, near] = out else { return Err(wrong_layers()) };
        let samples = nearest_with(source, self.threshold as f32, self.halo(window.cell), context.progress)?;
        let fade = self.fade();
        let metres = |steps: f32| (f64::from(steps) * window.cell).min(self.reach) as f32;
        for (layer, near) in [(distance, false), (near, true)] {
            let Some(layer) = layer else { continue };
            let width = window.width.max(1);
            for (row, samples) in layer.data_mut().chunks_mut(width).zip(samples.data().chunks(width)) {
                context.progress.check()?;
                for (out, steps) in row.iter_mut().zip(samples) {
                    *out = if near { fade.of(metres(*steps)) } else { metres(*steps) };
                }
            }
        }
        Ok(())
    }

    fn lower(&self, cell: f64, _: &WorldParams) -> Lowering<Passes> {
        let reach = self.halo(cell);
        let mut numbers = vec![self.threshold as f32, reach as f32, cell as f32, self.reach as f32];
        numbers.extend(self.fade().numbers());
        // Steps of 1, 2, 4, ... add up to every distance up to the reach.
        let doublings = usize::BITS - reach.leading_zeros();
        // At the end, plane 2 has the distances along the columns.
        let first = if doublings.is_multiple_of(2) { 2 } else { 1 };
        let steps = alternating(doublings, first, [2, 1]);
        let passes = Passes::new(CODE, &numbers).then("mark", first << 8, [0; 2]);
        let down = |passes: Passes, (k, step)| passes.then("down_columns", step | (1u32 << (16 + k)), [0; 2]);
        let passes = steps.into_iter().enumerate().fold(passes, down);
        let passes = passes.then("along_rows", 0, [reach; 2]).reading(2 * reach);
        Lowering::Shader(passes.then("measure", 0, [reach; 2]))
    }

    fn cost(&self, _: f64) -> f64 {
        15.0
    }
}

impl Distance {
    fn fade(&self) -> Selection {
        Selection::new([-1.0, 0.0], [0.0, self.reach])
    }
}
