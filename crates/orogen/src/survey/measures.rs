//! A piece of land in numbers.

use std::borrow::Cow;

use super::water::{self, Water};
use crate::analysis::aspect::aspect_of;
use crate::analysis::curvature::{Curvature, curvature};
use crate::analysis::geomorphons::{Look, geomorphons, shares};
use crate::analysis::roughness::ruggedness;
use crate::analysis::slope::from_gradients;
use crate::analysis::spectrum::{self, Band};
use crate::error::Result;
use crate::grid::Grid;
use crate::progress::Progress;

/// Slopes are counted in classes of so many degrees.
pub const SLOPE_CLASS: f64 = 2.0;

/// How far geomorphons look, in cells, and what counts as level, in degrees.
const SIGHT: usize = 10;
const LEVEL: f64 = 1.0;

/// Side of the blocks whose mean slopes are compared, in cells.
const BLOCK: usize = 32;

/// Bytes of a sample while its water is measured, which takes the most.
const SAMPLE: u64 = 48;

/// Steps of the hypsometric curve.
const STEPS: usize = 100;

/// What was measured.
#[derive(Debug, Clone)]
pub struct Measures {
    /// Samples of land.
    pub land: usize,
    /// Share of the samples that are land.
    pub land_share: f64,
    /// Lowest, mean and highest height in metres.
    pub heights: [f64; 3],
    /// The height that a thousandth of the land lies below, in metres.
    pub base: f64,
    /// From there to the height that a thousandth lies above: outliers do not count.
    pub relief: f64,
    /// Where the mean lies within that relief, 0 to 1.
    pub hypsometric_integral: f64,
    /// Mean slope in degrees.
    pub slope_mean: f64,
    /// The slope that half the land exceeds, and that a tenth of it exceeds.
    pub slope_median: f64,
    /// See [`Measures::slope_median`].
    pub slope_p90: f64,
    /// Standard deviation of rise over run, as a share of its mean.
    pub slope_spread: f64,
    /// The same of the means of blocks of 32 x 32 cells: how much steep land keeps together.
    pub slope_patches: f64,
    /// Root of the mean square of the total curvature, in 1/km.
    pub curvature: f64,
    /// How much heavier the concave tail of the curvature is than the convex, -1 to 1.
    pub curvature_skew: f64,
    /// Mean difference between neighbours, in metres.
    pub ruggedness: f64,
    /// Preference of slopes for multiples of 45 degrees, 0 to 1.
    pub grid_bias: f64,
    /// Exponent of the power spectrum.
    pub spectrum: Option<f64>,
    /// Hurst's exponent.
    pub hurst: Option<f64>,
    /// Share of each of the ten geomorphons.
    pub forms: [f64; 10],
    /// What water does.
    pub water: Water,
    /// Share of the land above heights evenly spaced from the lowest to the highest of the relief.
    pub hypsometry: Vec<f64>,
    /// Share of the land in each class of slope.
    pub slopes: Vec<f64>,
    /// Share of the land steeper than a degree that faces each 10 degrees, from north.
    pub aspects: Vec<f64>,
    /// Power by wavelength.
    pub bands: Vec<Band>,
}

impl Measures {
    /// Bytes that measuring so many samples takes at most, the heights themselves included.
    pub fn memory(samples: u64) -> u64 {
        samples.saturating_mul(SAMPLE)
    }

    /// Measures heights; what lies at or below the sea level, if there is one, is no land and does not count. None if fewer than 64 x 64
    /// samples or less than a hundredth of them are land, or all of it is level.
    pub fn of(heights: &Grid, sea_level: Option<f32>) -> Option<Measures> {
        Measures::of_with(heights, sea_level, &Progress::none()).ok().flatten()
    }

    /// [`Measures::of`] that reports how far it has come, and can be stopped.
    ///
    /// # Errors
    /// If the work is cancelled.
    pub fn of_with(heights: &Grid, sea_level: Option<f32>, progress: &Progress) -> Result<Option<Measures>> {
        // Sorted heights, slopes, curvatures, ruggedness, the spectrum, Hurst's exponent, geomorphons, water: by what each takes.
        let weights = [1.0, 2.0, 1.5, 0.5, 1.0, 1.0, 6.0, 4.0];
        progress.expect(weights.iter().sum());
        let mut phases = weights.into_iter();
        let mut phase = || {
            progress.advance(phases.next().unwrap_or(0.0));
            progress.check()
        };
        // Nothing that is as large as the land outlives what is counted of it.
        let land = match sea_level {
            Some(sea) if heights.data().iter().any(|height| *height <= sea) => {
                let mut land = heights.clone();
                land.data_mut().iter_mut().filter(|height| **height <= sea).for_each(|height| *height = f32::NAN);
                Cow::Owned(land)
            }
            _ => Cow::Borrowed(heights),
        };
        let Some(Heights { count, ends, mean, base, relief, integral, hypsometry }) = Heights::of(&land) else {
            return Ok(None);
        };
        phase()?;
        let Some(slope) = Slopes::of(&land) else { return Ok(None) };
        phase()?;
        let (curvature, skew) = bends(&land);
        phase()?;
        let ruggedness = mean_of(ruggedness(&land).data());
        phase()?;
        let bands = spectrum::spectrum(&land);
        phase()?;
        let hurst = spectrum::hurst(&land);
        phase()?;
        let forms = shares(&geomorphons(&land, &Look::square(SIGHT, LEVEL)));
        phase()?;
        let water = water::measure(&land);
        phase()?;
        Ok(Some(Measures {
            land: count,
            land_share: count as f64 / land.data().len() as f64,
            heights: [ends[0], mean, ends[1]],
            base,
            relief,
            hypsometric_integral: integral,
            slope_mean: slope.mean,
            slope_median: slope.median,
            slope_p90: slope.p90,
            slope_spread: slope.spread,
            slope_patches: slope.patches,
            curvature,
            curvature_skew: skew,
            ruggedness,
            grid_bias: slope.grid_bias,
            spectrum: spectrum::slope(&bands, land.window().cell),
            hurst,
            forms,
            water,
            hypsometry,
            slopes: slope.classes,
            aspects: slope.aspects,
            bands,
        }))
    }
}

/// The mean of what is finite.
fn mean_of(samples: &[f32]) -> f64 {
    let finite = samples.iter().filter(|sample| sample.is_finite());
    let (sum, count) = finite.fold((0.0, 0usize), |(sum, count), sample| (sum + f64::from(*sample), count + 1));
    sum / count as f64
}

/// What is finite, the least first.
fn sorted(grid: &Grid) -> Vec<f32> {
    let mut sorted: Vec<f32> = grid.data().iter().copied().filter(|sample| sample.is_finite()).collect();
    sorted.sort_unstable_by(f32::total_cmp);
    sorted
}

/// What is counted of heights.
struct Heights {
    count: usize,
    ends: [f64; 2],
    mean: f64,
    base: f64,
    relief: f64,
    integral: f64,
    hypsometry: Vec<f64>,
}

impl Heights {
    fn of(land: &Grid) -> Option<Heights> {
        let sorted = sorted(land);
        let count = sorted.len();
        if land.width().min(land.height()) < 64 || count * 100 < land.data().len() {
            return None;
        }
        let quantile = |share: f64| f64::from(sorted[(share * (count - 1) as f64) as usize]);
        let (low, high) = (quantile(0.001), quantile(0.999));
        let relief = high - low;
        if relief <= 0.0 {
            return None;
        }
        let clipped = sorted.iter().map(|height| f64::from(*height).clamp(low, high) - low).sum::<f64>() / count as f64;
        let hypsometry = (0..=STEPS)
            .map(|k| {
                let level = (low + relief * k as f64 / STEPS as f64) as f32;
                (count - sorted.partition_point(|height| *height < level)) as f64 / count as f64
            })
            .collect();
        Some(Heights {
            count,
            ends: [f64::from(sorted[0]), f64::from(sorted[count - 1])],
            mean: sorted.iter().map(|height| f64::from(*height)).sum::<f64>() / count as f64,
            base: low,
            relief,
            integral: clipped / relief,
            hypsometry,
        })
    }
}

/// Root of the mean square of the total curvature in 1/km, and how much heavier its concave tail is than the convex.
fn bends(land: &Grid) -> (f64, f64) {
    let bend = sorted(&curvature(land, Curvature::Total));
    // Means of the tails: quantiles of heights in whole metres would stand on steps.
    let tail = (bend.len() / 50).max(1);
    let (concave, convex) = (mean_of(&bend[..tail]), mean_of(&bend[bend.len() - tail..]));
    let middle = mean_of(&bend);
    let squares = bend.iter().map(|bend| f64::from(*bend) * f64::from(*bend)).sum::<f64>() / bend.len() as f64;
    (1000.0 * squares.sqrt(), (2.0 * middle - convex - concave) / (convex - concave).max(f64::MIN_POSITIVE))
}

/// What is counted of slopes.
struct Slopes {
    mean: f64,
    median: f64,
    p90: f64,
    spread: f64,
    patches: f64,
    grid_bias: f64,
    classes: Vec<f64>,
    aspects: Vec<f64>,
}

impl Slopes {
    fn of(land: &Grid) -> Option<Slopes> {
        let steep = from_gradients(land, |gradient| gradient.steepness());
        let faces = from_gradients(land, aspect_of);
        let count = steep.data().iter().filter(|rise| rise.is_finite()).count() as f64;
        let degrees = |rise: f32| f64::from(libm::atanf(rise)).to_degrees();
        let (mut classes, mut aspects) = (vec![0.0; (90.0 / SLOPE_CLASS) as usize], vec![0.0; 36]);
        let (mut sum, mut squares, mut angles) = (0.0, 0.0, 0.0);
        let (mut facing, mut cos, mut sin) = (0.0, 0.0, 0.0);
        let one_degree = libm::tan(1f64.to_radians()) as f32;
        for (rise, face) in steep.data().iter().zip(faces.data()).filter(|(rise, _)| rise.is_finite()) {
            let angle = degrees(*rise);
            angles += angle;
            sum += f64::from(*rise);
            squares += f64::from(*rise) * f64::from(*rise);
            let class = ((angle / SLOPE_CLASS) as usize).min(classes.len() - 1);
            classes[class] += 1.0 / count;
            if *rise > one_degree && face.is_finite() {
                facing += 1.0;
                aspects[(f64::from(*face) / 10.0 + 0.5) as usize % 36] += 1.0;
                let (s, c) = libm::sincos(8.0 * f64::from(*face).to_radians());
                cos += c;
                sin += s;
            }
        }
        if sum <= 0.0 {
            return None;
        }
        aspects.iter_mut().for_each(|share| *share /= f64::max(facing, 1.0));
        let mean = sum / count;
        drop(faces);
        let sorted = sorted(&steep);
        let at = |share: f64| degrees(sorted[(share * (sorted.len() - 1) as f64) as usize]);
        Some(Slopes {
            mean: angles / count,
            median: at(0.5),
            p90: at(0.9),
            spread: (squares / count - mean * mean).max(0.0).sqrt() / mean,
            patches: patches(&steep),
            grid_bias: (cos * cos + sin * sin).sqrt() / f64::max(facing, 1.0),
            classes,
            aspects,
        })
    }
}

/// Spread of the means over blocks that are at least half land, as a share of their mean.
fn patches(steep: &Grid) -> f64 {
    let (columns, rows) = (steep.width() / BLOCK, steep.height() / BLOCK);
    let mut means = Vec::new();
    for (j, i) in (0..rows).flat_map(|j| (0..columns).map(move |i| (j, i))) {
        let cells = (0..BLOCK).flat_map(|y| &steep.row(j * BLOCK + y)[i * BLOCK..(i + 1) * BLOCK]);
        let (sum, count) = cells
            .filter(|rise| rise.is_finite())
            .fold((0.0, 0usize), |(sum, count), rise| (sum + f64::from(*rise), count + 1));
        if 2 * count >= BLOCK * BLOCK {
            means.push(sum / count as f64);
        }
    }
    let count = means.len() as f64;
    let mean = means.iter().sum::<f64>() / count;
    let variance = means.iter().map(|block| (block - mean) * (block - mean)).sum::<f64>() / count;
    if mean > 0.0 { variance.sqrt() / mean } else { 0.0 }
}
