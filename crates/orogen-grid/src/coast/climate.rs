//! The winds of a coast with the waves that they raise.

use super::Coast;
use super::fetch;
use super::waves::{self, Waves, Wind};
use crate::error::Result;
use crate::grid::Window;
use crate::parallel;
use crate::progress::Progress;

/// The waves of all winds.
pub(super) struct Climate {
    pub(super) winds: Vec<Wind>,
    pub(super) waves: Waves,
    /// Maximum fetch, in metres.
    longest: f64,
    /// Power on an open coast.
    open: f64,
}

impl Climate {
    pub(super) fn new(law: &Coast) -> Climate {
        let (winds, waves) = (waves::winds(law), Waves::new(law));
        let open = waves.open(law, &winds);
        Climate { winds, waves, longest: law.fetch, open }
    }

    /// Power of the waves at all cells, over that of an open coast; 0 on land. `shore` is above 0 on land.
    pub(super) fn exposure(&self, window: &Window, shore: &[f32], progress: &Progress) -> Result<Vec<f32>> {
        let mut sum = vec![0.0f32; shore.len()];
        self.each(window, shore, progress, |_, wind, fetch| {
            let share = (wind.share / self.open.max(f64::MIN_POSITIVE)) as f32;
            let pieces = sum.chunks_mut(parallel::SAMPLES).zip(fetch.chunks(parallel::SAMPLES));
            parallel::for_each(pieces, |(sum, fetch)| {
                for (sum, fetch) in sum.iter_mut().zip(fetch) {
                    *sum += share * self.waves.of(*fetch)[0];
                }
            });
        })?;
        Ok(sum)
    }

    /// Calls `take` with the number of each wind, the wind and the fetches along it, in order.
    pub(super) fn each(
        &self,
        window: &Window,
        shore: &[f32],
        progress: &Progress,
        mut take: impl FnMut(usize, &Wind, &[f32]),
    ) -> Result<()> {
        let water: Vec<bool> = shore.iter().map(|shore| *shore <= 0.0).collect();
        for (batch, group) in self.winds.chunks(fetch::TOGETHER).enumerate() {
            progress.check()?;
            let sweep = |wind: Wind| fetch::sweep(&water, window, wind.from, self.longest as f32);
            let fetches = parallel::map(group.to_vec(), sweep);
            for (k, (wind, fetch)) in group.iter().zip(&fetches).enumerate() {
                take(batch * fetch::TOGETHER + k, wind, fetch);
            }
        }
        Ok(())
    }
}
