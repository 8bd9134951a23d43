//! Gaussian blur.

use crate::error::Result;
use crate::grid::{Grid, Window};
use crate::op::{Context, Filter};
use rayon::prelude::*;

op! {
    /// Gaussian blur: every sample becomes the mean of those around it, weighted by exp(-d^2 / 2 radius^2).
    ///
    /// The kernel is cut at three radii and its weights sum to 1. Rows first, then columns; each sum has a fixed order. Cost
    /// grows with radius / cell.
    pub struct Blur = "blur", filter, revision 1;
    inputs {
        /// What is blurred.
        source: required,
    }
    params {
        /// Standard deviation of the kernel.
        radius: f64 = 50.0, unit "m", range 0.0 to 1e6;
    }
}

/// Most samples a kernel may reach: what is wider would never end, and no memory holds its halo.
const FARTHEST: f64 = 16_384.0;

impl Blur {
    fn weights(&self, cell: f64) -> Vec<f32> {
        let sigma = self.radius / cell;
        let reach = self.halo(cell) as i64;
        let weights: Vec<f64> =
            (-reach..=reach).map(|d| libm::exp(-((d * d) as f64) / (2.0 * sigma * sigma))).collect();
        let sum: f64 = weights.iter().sum();
        weights.iter().map(|weight| (weight / sum) as f32).collect()
    }
}

impl Filter for Blur {
    fn halo(&self, cell: f64) -> usize {
        (3.0 * self.radius / cell).ceil().min(FARTHEST) as usize
    }

    fn scratch(&self, window: &Window) -> u64 {
        (window.width as u64) * (window.height as u64 + 2 * self.halo(window.cell) as u64) * 4
    }

    fn apply(
        &self,
        inputs: &[Option<&Grid>],
        window: &Window,
        out: &mut [Option<Grid>],
        context: &Context,
    ) -> Result<()> {
        let ([Some(source)], [Some(out)]) = (inputs, out) else { return Ok(()) };
        let reach = self.halo(window.cell);
        if reach == 0 || window.is_empty() {
            out.paste(source);
            return Ok(());
        }
        let weights = self.weights(window.cell);
        let width = window.width;
        let tall = window.height + 2 * reach;
        let mut rows = vec![0.0f32; width * tall];
        rows.par_chunks_mut(width).enumerate().try_for_each(|(j, row)| {
            context.progress.check()?;
            let source = source.row(j);
            for (step, weight) in weights.iter().enumerate() {
                accumulate(row, &source[step..step + width], *weight);
            }
            Ok(())
        })?;
        out.data_mut().par_chunks_mut(width).enumerate().try_for_each(|(j, row)| {
            context.progress.check()?;
            for (step, weight) in weights.iter().enumerate() {
                let at = (j + step) * width;
                accumulate(row, &rows[at..at + width], *weight);
            }
            Ok(())
        })
    }

    fn cost(&self, cell: f64) -> f64 {
        0.33 * (2 * self.halo(cell) + 1) as f64
    }
}

fn accumulate(out: &mut [f32], row: &[f32], weight: f32) {
    for (sum, sample) in out.iter_mut().zip(row) {
        *sum += weight * sample;
    }
}
