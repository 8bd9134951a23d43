//! Statistics of a terrain.

use super::land::{self, Land, ROWS};
use super::mean::Mean;
use super::sorted::{Samples, Sorted};
use super::water::{self, Water};
use orogen_grid::analysis::aspect::aspect_of;
use orogen_grid::analysis::curvature::{Curvature, curvature};
use orogen_grid::analysis::geomorphons::{Look, count, geomorphons, shares};
use orogen_grid::analysis::roughness::ruggedness;
use orogen_grid::analysis::slope::from_gradients;
use orogen_grid::analysis::spectrum::{self, Band, Rises};
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;
use serde::{Deserialize, Serialize};

/// Width of a class of slopes, in degrees.
pub const SLOPE_CLASS: f64 = 2.0;

/// Search radius of geomorphons in cells, and the limit of level ground in degrees.
const SIGHT: usize = 10;
const LEVEL: f64 = 1.0;

/// Side of the blocks whose mean slopes are compared, in cells: a block is never in two bands.
const BLOCK: usize = ROWS;

/// Memory per sample during the measurement of water, which needs the most, in bytes.
const SAMPLE: u64 = 48;

/// Samples that are sorted at a time if the heights are on disk.
const PART: usize = 4 << 20;

/// Memory of a spectrum beside its band of rows, in bytes.
const SPECTRUM: u64 = 12 << 20;

/// Steps of the hypsometric curve.
const STEPS: usize = 100;

/// The statistics of a terrain.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Measures {
    /// Number of land samples.
    pub land: usize,
    /// The share of samples that are land, 0 to 1.
    pub land_share: f64,
    /// Minimum, mean and maximum height, in metres.
    pub heights: [f64; 3],
    /// The 0.1 % quantile of heights, in metres.
    pub base: f64,
    /// The 99.9 % quantile minus `base`, in metres, which excludes outliers.
    pub relief: f64,
    /// The position of the mean within the relief, 0 to 1.
    pub hypsometric_integral: f64,
    /// Mean slope, in degrees.
    pub slope_mean: f64,
    /// Median slope, in degrees.
    pub slope_median: f64,
    /// 90 % quantile of slope, in degrees.
    pub slope_p90: f64,
    /// Coefficient of variation of the slope (rise over run).
    pub slope_spread: f64,
    /// The same for the means of blocks of 32 x 32 cells: how strongly steep land is clustered.
    pub slope_patches: f64,
    /// Root mean square of the total curvature, in 1/km.
    pub curvature: f64,
    /// Skew of the curvature: how much heavier its concave tail is than the convex one, -1 to 1.
    pub curvature_skew: f64,
    /// Mean difference between neighbors, in metres.
    pub ruggedness: f64,
    /// Preference of slopes for multiples of 45 degrees, 0 to 1.
    pub grid_bias: f64,
    /// Exponent of the power spectrum; see [`spectrum::spectral_slope`].
    pub spectrum: Option<f64>,
    /// Hurst exponent.
    pub hurst: Option<f64>,
    /// Shares of the ten geomorphons.
    pub forms: [f64; 10],
    /// Statistics of the drainage.
    pub water: Water,
    /// Share of the land above evenly spaced heights from the bottom to the top of the relief.
    pub hypsometry: Vec<f64>,
    /// Share of the land in each class of slope.
    pub slopes: Vec<f64>,
    /// Share of the land steeper than one degree in each 10 degrees of aspect, from north.
    pub aspects: Vec<f64>,
    /// Power spectrum.
    pub bands: Vec<Band>,
}

impl Measures {
    /// Maximum memory for measuring this many samples, in bytes, including the heights.
    #[must_use]
    pub fn memory(samples: u64) -> u64 {
        samples.saturating_mul(SAMPLE)
    }

    /// Memory for measuring a window with heights on disk, in bytes, without its rivers, whose number is known only
    /// afterwards.
    #[must_use]
    pub fn memory_on_disk(window: &Window) -> u64 {
        let rows = 4 * 512 * window.width as u64;
        let sorting = 4 * PART as u64 + (2 << 20);
        let counting = land::band_memory(window) + sorting.max(SPECTRUM + rows);
        counting.max(water::memory_on_disk(window))
    }

    /// Measures land whose water `water` measures.
    pub(super) fn made(
        land: &Land,
        progress: &Progress,
        water: &dyn Fn(&Land, &Progress) -> Result<Water>,
    ) -> Result<Option<Measures>> {
        // Sorted heights, slopes, curvatures, ruggedness, the spectrum, the Hurst exponent, geomorphons, water:
        // weighted by time.
        let weights = match land.is_on_disk() {
            false => [1.0, 2.0, 1.5, 0.5, 1.0, 1.0, 6.0, 8.0],
            true => [2.0, 4.0, 3.0, 0.5, 1.0, 1.0, 6.0, 40.0],
        };
        let window = *land.window();
        let phases = progress.parts(weights);
        let part = |k: usize, halo: usize| Part { land, progress: &phases[k], halo };
        let Some(Heights { count: samples, ends, mean, base, relief, integral, hypsometry }) =
            Heights::of(&part(0, 0))?
        else {
            return Ok(None);
        };
        let Some(slope) = SlopeStatistics::of(&part(1, 1))? else { return Ok(None) };
        let (curvature, skew) = bends(&part(2, 1))?;
        let mut rugged = Mean::default();
        part(3, 1).bands(|band| {
            rugged.add(ruggedness(band).data());
            Ok(())
        })?;
        let bands = spectrum::spectrum_of_rows(&window, |rows| {
            phases[4].check()?;
            land.rows(rows)
        })?;
        phases[4].finish();
        let hurst = hurst(land, &phases[5])?;
        let mut counts = [0u64; 11];
        part(6, SIGHT).bands(|band| {
            let forms = geomorphons(band, &Look::square(SIGHT, LEVEL));
            count(&forms, &mut counts);
            Ok(())
        })?;
        let water = water(land, &phases[7])?;
        phases[7].finish();
        Ok(Some(Measures {
            land: samples,
            land_share: samples as f64 / window.len() as f64,
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
            ruggedness: rugged.mean(),
            grid_bias: slope.grid_bias,
            spectrum: spectrum::spectral_slope(&bands, window.cell),
            hurst,
            forms: shares(&counts),
            water,
            hypsometry,
            slopes: slope.classes,
            aspects: slope.aspects,
            bands,
        }))
    }
}

/// The part of the land whose samples have `halo` others on each side.
struct Part<'a> {
    land: &'a Land<'a>,
    progress: &'a Progress,
    halo: usize,
}

impl Part<'_> {
    /// Visits bands of it, and checks for cancellation.
    fn bands(&self, mut visit: impl FnMut(&Grid) -> Result<()>) -> Result<()> {
        self.land.bands(self.halo, |band| {
            self.progress.check()?;
            visit(band)
        })
    }

    /// Computes a grid from each band and passes its samples to `with` in ascending order.
    fn sorted<T>(&self, made: impl Fn(&Grid) -> Grid, with: impl FnOnce(&Sorted) -> Result<T>) -> Result<T> {
        let samples: &Samples = &|visit| {
            self.bands(|band| {
                visit(made(band).data());
                Ok(())
            })
        };
        let sorted = match self.land.is_on_disk() {
            true => Sorted::in_parts(samples, PART)?,
            false => Sorted::held(samples)?,
        };
        let result = with(&sorted);
        self.progress.finish();
        result
    }
}

/// The Hurst exponent.
fn hurst(land: &Land, progress: &Progress) -> Result<Option<f64>> {
    let (height, mut rises) = (land.window().height, Rises::default());
    for first in (0..height).step_by(8 * ROWS) {
        progress.check()?;
        let rows = (8 * ROWS).min(height - first);
        rises.add(&land.rows(first..(first + rows + Rises::BELOW).min(height))?, rows);
    }
    progress.finish();
    Ok(rises.hurst(land.window()))
}

/// Statistics of heights.
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
    fn of(land: &Part) -> Result<Option<Heights>> {
        let window = land.land.window();
        land.sorted(Grid::clone, |sorted| {
            let count = sorted.count();
            if window.width.min(window.height) < 64 || count * 100 < window.len() as u64 {
                return Ok(None);
            }
            let place = |share: f64| (share * (count - 1) as f64) as u64;
            let places = [0, place(0.001), place(0.999), count - 1];
            let [least, low, high, most] = sorted.at(places)?.map(f64::from);
            let relief = high - low;
            if relief <= 0.0 {
                return Ok(None);
            }
            let level = |k: usize| (low + relief * k as f64 / STEPS as f64) as f32;
            let levels: Vec<f32> = (0..=STEPS).map(level).collect();
            let (mut clipped, mut sum, mut below) = (0.0, 0.0, vec![0u64; levels.len()]);
            sorted.each(&mut |some| {
                for height in some.iter().map(|height| f64::from(*height)) {
                    clipped += height.clamp(low, high) - low;
                    sum += height;
                }
                for (below, level) in below.iter_mut().zip(&levels) {
                    *below += some.partition_point(|height| height < level) as u64;
                }
            })?;
            let count_f64 = count as f64;
            Ok(Some(Heights {
                count: count as usize,
                ends: [least, most],
                mean: sum / count_f64,
                base: low,
                relief,
                integral: clipped / count_f64 / relief,
                hypsometry: below.into_iter().map(|below| (count - below) as f64 / count_f64).collect(),
            }))
        })
    }
}

/// Root mean square of the total curvature in 1/km, and how much heavier its concave tail is than the convex one.
fn bends(land: &Part) -> Result<(f64, f64)> {
    land.sorted(
        |band| curvature(band, Curvature::Total),
        |bend| {
            // Means of the tails: with heights in whole metres, quantiles would lie on steps.
            let count = bend.count();
            let tail = (count / 50).max(1);
            let [mut concave, mut convex, mut middle] = [Mean::default(); 3];
            let (mut squares, mut before) = (0.0, 0);
            bend.each(&mut |some| {
                let (first, end) = (before, before + some.len() as u64);
                let within = |from: u64, to: u64| {
                    let [from, to] = [from, to].map(|at| (at.clamp(first, end) - first) as usize);
                    &some[from..to]
                };
                concave.add(within(0, tail));
                convex.add(within(count.saturating_sub(tail), count));
                middle.add(some);
                for bend in some {
                    squares += f64::from(*bend) * f64::from(*bend);
                }
                before = end;
            })?;
            let [concave, convex, middle] = [concave, convex, middle].map(|mean| mean.mean());
            let root = (squares / count as f64).sqrt();
            Ok((1000.0 * root, (2.0 * middle - convex - concave) / (convex - concave).max(f64::MIN_POSITIVE)))
        },
    )
}

/// Statistics of slopes.
struct SlopeStatistics {
    mean: f64,
    median: f64,
    p90: f64,
    spread: f64,
    patches: f64,
    grid_bias: f64,
    classes: Vec<f64>,
    aspects: Vec<f64>,
}

impl SlopeStatistics {
    fn of(land: &Part) -> Result<Option<SlopeStatistics>> {
        let degrees = |rise: f32| f64::from(libm::atanf(rise)).to_degrees();
        let order = land.sorted(
            |band| from_gradients(band, |gradient| gradient.steepness()),
            |sorted| {
                let place = |share: f64| (share * sorted.count().saturating_sub(1) as f64) as u64;
                Ok((sorted.count() as f64, sorted.at([place(0.5), place(0.9)])?))
            },
        );
        let (count, [median, p90]) = order?;
        let (mut classes, mut aspects) = (vec![0.0; (90.0 / SLOPE_CLASS) as usize], vec![0.0; 36]);
        let (mut sum, mut squares, mut angles) = (0.0, 0.0, 0.0);
        let (mut facing, mut cos, mut sin) = (0.0, 0.0, 0.0);
        let one_degree = libm::tan(1f64.to_radians()) as f32;
        let mut blocks = Vec::new();
        land.bands(|band| {
            let steep = from_gradients(band, |gradient| gradient.steepness());
            let faces = from_gradients(band, aspect_of);
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
            means_of_blocks(&steep, &mut blocks);
            Ok(())
        })?;
        if sum <= 0.0 {
            return Ok(None);
        }
        aspects.iter_mut().for_each(|share| *share /= f64::max(facing, 1.0));
        let mean = sum / count;
        Ok(Some(SlopeStatistics {
            mean: angles / count,
            median: degrees(median),
            p90: degrees(p90),
            spread: (squares / count - mean * mean).max(0.0).sqrt() / mean,
            patches: patches(&blocks),
            grid_bias: (cos * cos + sin * sin).sqrt() / f64::max(facing, 1.0),
            classes,
            aspects,
        }))
    }
}

/// Adds the means of blocks that are at least half land.
fn means_of_blocks(steep: &Grid, means: &mut Vec<f64>) {
    let (columns, rows) = (steep.width() / BLOCK, steep.height() / BLOCK);
    for (j, i) in (0..rows).flat_map(|j| (0..columns).map(move |i| (j, i))) {
        let mut block = Mean::default();
        (0..BLOCK).for_each(|y| block.add(&steep.row(j * BLOCK + y)[i * BLOCK..(i + 1) * BLOCK]));
        if 2 * block.count() >= BLOCK * BLOCK {
            means.push(block.mean());
        }
    }
}

/// The coefficient of variation of the means.
fn patches(means: &[f64]) -> f64 {
    let count = means.len() as f64;
    let mean = means.iter().sum::<f64>() / count;
    let variance = means.iter().map(|block| (block - mean) * (block - mean)).sum::<f64>() / count;
    if mean > 0.0 { variance.sqrt() / mean } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::survey::job::SurveyJob;
    use orogen_grid::hydrology::samples;
    use orogen_io::pages::Pages;
    use orogen_io::raster::Raster;

    #[test]
    fn heights_on_disk_have_the_numbers_of_heights_in_memory() {
        let folder = std::env::temp_dir();
        // More rows and columns than a tile, a page and a band have, and fewer.
        for (k, (width, height)) in [(600, 300), (70, 530), (300, 64), (64, 300)].into_iter().enumerate() {
            // Long slopes with hills, and cells so large that rivers start early.
            let mut hills = samples::hills(width, height, k as i64);
            for j in 0..height {
                hills.row_mut(j).iter_mut().enumerate().for_each(|(i, h)| *h += 9.0 * (i + j) as f32);
            }
            let mut grid = Grid::from_data(Window::new(width, height, 100.0).at(-3, 8), hills.data().to_vec()).unwrap();
            if k == 1 {
                (100..140).for_each(|j| grid.row_mut(j)[20..50].fill(f32::NAN));
            }
            let mut heights: Vec<f32> = grid.data().iter().copied().filter(|height| height.is_finite()).collect();
            heights.sort_unstable_by(f32::total_cmp);
            for sea_level in [None, Some(heights[heights.len() / 3])] {
                let mut raster = Raster::on_disk(Pages::scratch(&folder, *grid.window()).unwrap());
                raster.put(&grid).unwrap();
                let made =
                    SurveyJob::new(Land::on_disk(&raster, sea_level)).with_scratch(&folder).measure(&Progress::none());
                let expect = Measures::of(&grid, sea_level).unwrap();
                assert!(expect.water.order > 1 && expect.water.area_exponent.is_some(), "{:?}", expect.water.order);
                // The digits of a number identify its bits.
                assert_eq!(format!("{:?}", made.unwrap().unwrap()), format!("{expect:?}"));
            }
        }
        let level = Grid::filled(Window::new(80, 80, 10.0), 5.0);
        let raster = Raster::in_memory(level);
        let none = SurveyJob::new(Land::on_disk(&raster, None)).with_scratch(&folder).measure(&Progress::none());
        assert!(none.unwrap().is_none());
    }
}
