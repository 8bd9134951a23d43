//! How far it is to something.

use crate::analysis::distance::nearest;
use crate::analysis::selection::Selection;
use crate::error::Result;
use crate::grid::{Grid, Window};
use crate::op::{Context, Filter};

op! {
    /// The distance to the nearest sample at which the source reaches a threshold, and a mask of what is near.
    ///
    /// To a river (`drainage.flow` from an area on), a lake, the sea, another mask. Exact between samples (Meijster, Roerdink and Hesselink 2000), up to
    /// `reach`; the window is made with so much more on each side. About 15 ns a sample, whatever the reach.
    pub struct Distance = "distance", filter, revision 1;
    inputs {
        /// What is looked for.
        source: required,
    }
    params {
        /// The value of the source from which on a sample counts.
        threshold: f64 = 0.5, range -1e18 to 1e18;
        /// How far it looks; what is farther is so far.
        reach: f64 = 500.0, unit "m", range 0.0 to 1e6;
    }
    layers {
        /// The distance.
        distance: height, unit "m";
        /// 1 where the source reaches the threshold, falling smoothly to 0 at `reach`.
        near: height;
    }
}

/// Most samples that it may look.
const FARTHEST: f64 = 16_384.0;

impl Filter for Distance {
    fn halo(&self, cell: f64) -> usize {
        (self.reach / cell).ceil().min(FARTHEST) as usize
    }

    fn scratch(&self, window: &Window) -> u64 {
        let grown = window.grown(self.halo(window.cell));
        // Distances down the columns, and those that are found.
        4 * grown.width as u64 * window.height as u64 + 4 * window.len() as u64
    }

    fn apply(
        &self,
        inputs: &[Option<&Grid>],
        window: &Window,
        out: &mut [Option<Grid>],
        context: &Context,
    ) -> Result<()> {
        let ([Some(source)], [distance, near]) = (inputs, out) else { return Ok(()) };
        context.progress.check()?;
        let samples = nearest(source, self.threshold as f32, self.halo(window.cell));
        let fade = Selection::new([-1.0, 0.0], [0.0, self.reach]);
        let metres = |steps: f32| (f64::from(steps) * window.cell).min(self.reach) as f32;
        for (layer, near) in [(distance, false), (near, true)] {
            let Some(layer) = layer else { continue };
            for (out, steps) in layer.data_mut().iter_mut().zip(samples.data()) {
                *out = if near { fade.of(metres(*steps)) } else { metres(*steps) };
            }
        }
        Ok(())
    }

    fn cost(&self, _: f64) -> f64 {
        15.0
    }
}
