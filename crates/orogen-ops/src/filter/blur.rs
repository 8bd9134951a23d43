//! Gaussian blur.

use crate::budget::memory;
use crate::lower::{Lowering, Passes};
use crate::op::{Context, Filter, GridInputs, WorldParams, only_layer};
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::parallel;

op! {
    /// Gaussian blur: the mean of the surrounding samples, weighted by exp(-d^2 / 2 radius^2).
    ///
    /// The kernel is truncated at three standard deviations and its weights sum to 1. It is applied to rows, then to
    /// columns; each sum has a fixed order. The time grows with radius / cell.
    pub struct Blur = "blur", filter, revision 1;
    inputs {
        /// The values to blur.
        source: required,
    }
    params {
        /// Standard deviation of the kernel.
        radius: f64 = 50.0, unit "m", range 0.0 to 1e6;
    }
}

/// Maximum reach of the kernel in samples. A wider kernel would take too long, and its halo would not fit in memory.
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

const CODE: &str = include_str!("blur.wgsl");

impl Filter for Blur {
    fn halo(&self, cell: f64) -> usize {
        (3.0 * self.radius / cell).ceil().min(FARTHEST) as usize
    }

    fn scratch(&self, window: &Window) -> u64 {
        let reach = self.halo(window.cell);
        // One tile for each band in progress; all bands may be in progress.
        let rows = window.height.div_ceil(band(reach)).saturating_mul(band(reach) + 2 * reach);
        memory(&Window { width: TILE, height: rows, ..*window }, 4)
    }

    fn apply(&self, inputs: &GridInputs, window: &Window, out: &mut [Option<Grid>], context: &Context) -> Result<()> {
        let source = inputs.required("source")?;
        let out = only_layer(out)?;
        let reach = self.halo(window.cell);
        if reach == 0 || window.is_empty() {
            out.paste(source);
            return Ok(());
        }
        let weights = self.weights(window.cell);
        let band = band(reach);
        context.progress.expect(window.len() as f64);
        parallel::try_for_each_init(
            out.data_mut().chunks_mut(band * window.width).enumerate(),
            || vec![0.0f32; TILE * (band + 2 * reach)],
            |rows, (b, out)| {
                let (top, height) = (b * band, out.len() / window.width);
                for left in (0..window.width).step_by(TILE) {
                    let width = TILE.min(window.width - left);
                    context.progress.step((width * height) as f64)?;
                    // First along x into rows that stay in the cache, then along y from these rows.
                    for (j, row) in rows.chunks_mut(TILE).take(height + 2 * reach).enumerate() {
                        let source = &source.row(top + j)[left..];
                        weigh(&mut row[..width], &weights, source, 1);
                    }
                    for (j, row) in out.chunks_mut(window.width).enumerate() {
                        weigh(&mut row[left..left + width], &weights, &rows[j * TILE..], TILE);
                    }
                }
                Ok(())
            },
        )
    }

    fn lower(&self, cell: f64, _: &WorldParams) -> Lowering<Passes> {
        let reach = self.halo(cell);
        let weights = if reach == 0 { vec![1.0] } else { self.weights(cell) };
        let count = weights.len();
        let words = std::iter::once(count as u32).chain(weights.iter().map(|weight| weight.to_bits()));
        let passes = Passes::new(CODE, &[]).with_words(words).with_scratch(1);
        let passes = passes.then("rows", 0, [reach, 0]).reading(count).then("columns", 0, [reach; 2]).reading(count);
        Lowering::Shader(passes)
    }

    fn cost(&self, cell: f64) -> f64 {
        0.33 * (2 * self.halo(cell) + 1) as f64
    }
}

/// Columns of a tile.
const TILE: usize = 256;

/// Rows of a band: so many that the rows shared by two bands cost little.
fn band(reach: usize) -> usize {
    (4 * reach).max(256)
}

/// Each value of `out` becomes the weighted sum of as many samples of `from` as there are weights, `step` apart,
/// starting at the same index. Sums run in the order of the weights; many sums are computed at once in registers.
fn weigh(out: &mut [f32], weights: &[f32], from: &[f32], step: usize) {
    const ABREAST: usize = 32;
    let (registers, rest) = out.as_chunks_mut::<ABREAST>();
    let done = registers.len() * ABREAST;
    for (r, out) in registers.iter_mut().enumerate() {
        let mut sums = [0.0f32; ABREAST];
        for (k, weight) in weights.iter().enumerate() {
            let samples = &from[r * ABREAST + k * step..][..ABREAST];
            for (sum, sample) in sums.iter_mut().zip(samples) {
                *sum += weight * sample;
            }
        }
        *out = sums;
    }
    for (i, out) in rest.iter_mut().enumerate() {
        *out = 0.0;
        for (k, weight) in weights.iter().enumerate() {
            *out += weight * from[done + i + k * step];
        }
    }
}
