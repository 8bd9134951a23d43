//! Measures that a stretch of the heights changes: for fits, which try many of them.

use orogen_grid::grid::Grid;

/// The height below which this share of the samples is; 0 without samples.
#[must_use]
pub fn quantile(grid: &Grid, share: f64) -> f64 {
    let mut heights = grid.data().to_vec();
    let at = (share * (heights.len().max(1) - 1) as f64) as usize;
    if heights.is_empty() { 0.0 } else { f64::from(*heights.select_nth_unstable_by(at, f32::total_cmp).1) }
}

/// The position of the mean in the relief, as in [`Measures`](super::measures::Measures).
#[must_use]
pub fn integral(grid: &Grid) -> f64 {
    let (low, high) = (quantile(grid, 0.001), quantile(grid, 0.999));
    let sum: f64 = grid.data().iter().map(|height| f64::from(*height).clamp(low, high) - low).sum();
    sum / grid.data().len() as f64 / (high - low).max(1e-12)
}

/// The mean slope in degrees of ground that rises `factor` times as steeply as `rises`.
#[must_use]
pub fn mean_slope(rises: &Grid, factor: f32) -> f64 {
    let angles = rises.data().iter().map(|rise| f64::from(libm::atanf(*rise * factor)));
    angles.sum::<f64>().to_degrees() / rises.data().len().max(1) as f64
}
