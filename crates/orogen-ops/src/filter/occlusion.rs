//! Ambient occlusion of terrain.

use crate::lower::{Lowering, Passes};
use crate::op::{Context, Filter, GridInputs, WorldParams, only_layer};
use orogen_grid::analysis::sky::{sky_view_with, steps_of_view};
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};

op! {
    /// Ambient occlusion: the visible share of the sky, from 0 in the deepest gorges to 1 on open ground.
    ///
    /// This is the sky-view factor (Zakšek, Oštir and Kokalj 2011). Horizons are searched in 16 directions, at steps of
    /// 1, 2, 3, 4, 6, 8, 12, 16 ... samples. Missing heights hide nothing. The time grows with the logarithm of the
    /// reach.
    pub struct Occlusion = "occlusion", filter, revision 1;
    inputs {
        /// The heights.
        source: required,
    }
    params {
        /// Search radius of horizons; at least 1 sample, at most 128 samples.
        reach: f64 = 1000.0, unit "m", range 0.0 to 1e6;
    }
    layers {
        /// The visible share of the sky.
        occlusion: height;
    }
}

/// Maximum search radius in samples.
const FARTHEST: f64 = 128.0;

impl Filter for Occlusion {
    fn halo(&self, cell: f64) -> usize {
        (self.reach / cell).ceil().clamp(1.0, FARTHEST) as usize
    }

    fn apply(&self, inputs: &GridInputs, window: &Window, out: &mut [Option<Grid>], context: &Context) -> Result<()> {
        let source = inputs.required("source")?;
        let out = only_layer(out)?;
        *out = sky_view_with(source, window, self.halo(window.cell), context.progress)?;
        Ok(())
    }

    fn lower(&self, cell: f64, _: &WorldParams) -> Lowering<Passes> {
        let reach = self.halo(cell);
        let steps = steps_of_view(reach, cell);
        let words = [steps.len() as u32].into_iter().chain(steps.iter().flat_map(|step| {
            let [east, south] = step.offset.map(|side| (side as i32).cast_unsigned());
            [east, south, step.per_metre.to_bits(), step.share.to_bits()]
        }));
        let passes = Passes::new(include_str!("occlusion.wgsl"), &[]).with_words(words);
        Lowering::Shader(passes.then("view", 0, [reach; 2]).reading(steps.len()))
    }

    fn cost(&self, cell: f64) -> f64 {
        // 16 directions with about two steps each time that the distance doubles.
        32.0 * libm::log2(self.halo(cell) as f64 + 1.0)
    }
}
