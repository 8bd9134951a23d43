//! Roughness by wavelength: the power spectrum and the structure function.

use super::fourier::power;
use crate::error::Result;
use crate::grid::{Grid, Window};
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Side of the largest square that is transformed. Larger grids are covered by several squares.
const LARGEST: usize = 512;

/// Number of wavelength classes per octave.
const CLASSES_AN_OCTAVE: f64 = 3.0;

/// The distances, in cells, at which [`hurst`] compares heights.
const LAGS: [usize; 7] = [2, 3, 4, 6, 8, 12, 16];

/// Mean power of a wavelength class.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Band {
    /// Wavelength of the class, in metres.
    pub wavelength: f64,
    /// Power density, in m^4: m^2 of height variance times m^2 of area.
    pub power: f64,
}

/// The power spectrum, averaged over all directions, for wavelengths from two cells to half a side. The grid is covered
/// by squares of 2^n samples, at most 512 along a side. Their least-squares planes are subtracted, Hann's window is
/// applied, and their powers are averaged. Empty if the grid has fewer than 16 samples along a side. NaN is replaced
/// with the plane.
#[must_use]
pub fn spectrum(grid: &Grid) -> Vec<Band> {
    let window = grid.window();
    let rows = |rows: Range<usize>| {
        let part = Window { y: window.y + rows.start as i64, height: rows.len(), ..*window };
        Ok(grid.crop(&part).unwrap_or_else(|| Grid::filled(part, f32::NAN)))
    };
    spectrum_of_rows(window, rows).unwrap_or_default()
}

/// [`spectrum`] of a window whose rows are read in bands of at most 512.
///
/// # Errors
/// The errors of `rows`.
pub fn spectrum_of_rows(window: &Window, rows: impl Fn(Range<usize>) -> Result<Grid>) -> Result<Vec<Band>> {
    let least = window.width.min(window.height);
    if least < 16 {
        return Ok(Vec::new());
    }
    let side = (1usize << least.ilog2()).min(LARGEST);
    let cell = window.cell;
    let starts = |length: usize| {
        let count = length.div_ceil(side);
        (0..count).map(move |k| if count == 1 { 0 } else { k * (length - side) / (count - 1) }).collect::<Vec<_>>()
    };
    let weights: Vec<f64> =
        (0..side).map(|k| 0.5 - 0.5 * libm::cos(std::f64::consts::TAU * k as f64 / (side - 1) as f64)).collect();
    let energy: f64 = weights.iter().map(|w| w * w).sum::<f64>();
    let mut total = vec![0.0; side * side];
    let mut squares = 0.0;
    for top in starts(window.height) {
        let band = rows(top..top + side)?;
        for left in starts(window.width) {
            let mut square = level(&band, left, 0, side);
            for (k, sample) in square.iter_mut().enumerate() {
                *sample *= weights[k % side] * weights[k / side];
            }
            total.iter_mut().zip(power(&square, side)).for_each(|(sum, power)| *sum += power);
            squares += 1.0;
        }
    }
    // Normalized to a density: power per unit area of frequencies, divided by the energy of Hann's window.
    let scale = cell * cell / (energy * energy * squares);
    let classes = (f64::from(side.ilog2() - 2) * CLASSES_AN_OCTAVE) as usize;
    let mut bands = vec![(0.0, 0.0, 0.0); classes];
    for (k, power) in total.iter().enumerate() {
        let frequency = |n: usize| n.min(side - n) as f64;
        let (i, j) = (frequency(k % side), frequency(k / side));
        let waves = (i * i + j * j).sqrt();
        if waves < 2.0 || waves > side as f64 / 2.0 {
            continue;
        }
        let class = (libm::log2(waves / 2.0) * CLASSES_AN_OCTAVE + 1e-9) as usize;
        if let Some((count, waves_sum, sum)) = bands.get_mut(class) {
            *count += 1.0;
            *waves_sum += waves;
            *sum += power * scale;
        }
    }
    let length = side as f64 * cell;
    let mean = bands
        .into_iter()
        .filter(|(count, _, sum)| *count > 0.0 && *sum > 0.0)
        .map(|(count, waves, sum)| Band { wavelength: length * count / waves, power: sum / count });
    Ok(mean.collect())
}

/// The exponent beta of P ~ wavelength^beta (-beta as a power of the frequency), fitted between wavelengths of 4 and 64
/// cells. Real terrain has 3.2 to 4.4 at 30 to 90 m. A surface with Hurst exponent H has beta = 2 H + 2. `None` if
/// there are too few classes.
#[must_use]
pub fn spectral_slope(bands: &[Band], cell: f64) -> Option<f64> {
    let points: Vec<(f64, f64)> = bands
        .iter()
        .filter(|band| (4.0 * cell..=64.0 * cell).contains(&band.wavelength))
        .map(|band| (libm::log(band.wavelength), libm::log(band.power)))
        .collect();
    line(&points)
}

/// Half the slope of the structure function in logarithms: mean squared differences of heights at 2 to 16 cells along
/// both axes. For fractional Brownian surfaces this is the Hurst exponent H. `None` if there is no relief.
#[must_use]
pub fn hurst(grid: &Grid) -> Option<f64> {
    let mut rises = Rises::default();
    rises.add(grid, grid.height());
    rises.hurst(grid.window())
}

/// Squared differences of heights, for [`hurst`].
#[derive(Debug, Clone, Copy, Default)]
pub struct Rises {
    sums: [f64; LAGS.len()],
    counts: [u64; LAGS.len()],
}

impl Rises {
    /// Number of rows below the added ones that [`Rises::add`] reads if they exist.
    pub const BELOW: usize = LAGS[LAGS.len() - 1];

    /// Adds the differences that start in the first `rows` rows of `band`. The rows below them are only read.
    pub fn add(&mut self, band: &Grid, rows: usize) {
        for ((lag, sum), count) in LAGS.into_iter().zip(&mut self.sums).zip(&mut self.counts) {
            for j in 0..rows {
                let row = band.row(j);
                let east = row.iter().zip(row.get(lag..).unwrap_or_default());
                let below = if j + lag < band.height() { band.row(j + lag) } else { &[] };
                for (a, b) in east.chain(row.iter().zip(below)) {
                    let rise = f64::from(*a) - f64::from(*b);
                    let square = rise * rise;
                    if square.is_finite() {
                        *sum += square;
                        *count += 1;
                    }
                }
            }
        }
    }

    /// The exponent, after all rows of `window` were added.
    #[must_use]
    pub fn hurst(&self, window: &Window) -> Option<f64> {
        if window.width.min(window.height) <= Rises::BELOW {
            return None;
        }
        let points: Vec<(f64, f64)> = (LAGS.iter().zip(self.sums).zip(self.counts))
            .filter_map(|((lag, sum), count)| {
                let mean = sum / count as f64;
                (mean > 0.0).then(|| (libm::log(*lag as f64), libm::log(mean)))
            })
            .collect();
        Some(0.5 * line(&points)?)
    }
}

/// A square of the grid minus its least-squares plane.
fn level(grid: &Grid, left: usize, top: usize, side: usize) -> Vec<f64> {
    let middle = (side as f64 - 1.0) / 2.0;
    let at = |i: usize, j: usize| f64::from(grid[(left + i, top + j)]);
    let (mut mean, mut count, mut east, mut south, mut squares) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for j in 0..side {
        for i in 0..side {
            let (x, y, z) = (i as f64 - middle, j as f64 - middle, at(i, j));
            if z.is_finite() {
                mean += z;
                count += 1.0;
                east += x * z;
                south += y * z;
                squares += x * x;
            }
        }
    }
    let (mean, east, south) = (mean / f64::max(count, 1.0), east / squares, south / squares);
    let mut out = Vec::with_capacity(side * side);
    for j in 0..side {
        for i in 0..side {
            let z = at(i, j) - mean - east * (i as f64 - middle) - south * (j as f64 - middle);
            out.push(if z.is_finite() { z } else { 0.0 });
        }
    }
    out
}

/// The slope of the least-squares line through at least four points.
fn line(points: &[(f64, f64)]) -> Option<f64> {
    let count = points.len() as f64;
    let (sx, sy) = points.iter().fold((0.0, 0.0), |(sx, sy), (x, y)| (sx + x, sy + y));
    let (mx, my) = (sx / count, sy / count);
    let (sxx, sxy) =
        points.iter().fold((0.0, 0.0), |(sxx, sxy), (x, y)| (sxx + (x - mx) * (x - mx), sxy + (x - mx) * (y - my)));
    (points.len() >= 4 && sxx > 0.0).then(|| sxy / sxx)
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_noise::{Basis, Fractal, Kind, Points};

    /// fBm with Hurst exponent H has octaves of gain 2^-H, a power of wavelength^(2 H + 2) and rises of distance^(2 H).
    #[test]
    fn fractional_brownian_land_has_its_own_exponents() {
        for hurst_exponent in [0.4, 0.7] {
            let window = Window::new(600, 520, 30.0);
            let fractal = Fractal::new(3, 20_000.0)
                .with_basis(Basis::Perlin)
                .with_kind(Kind::Fbm)
                .with_octaves(12)
                .with_lacunarity(2.0)
                .with_gain(libm::pow(2.0, -hurst_exponent));
            let mut grid = Grid::filled(window, 0.0f32);
            let (xs, ys) = (window.eastings(), window.southings());
            fractal.fill(&Points::Lattice { xs: &xs, ys: &ys }, grid.data_mut()).unwrap();
            let bands = spectrum(&grid);
            let beta = spectral_slope(&bands, 30.0).unwrap();
            assert!((beta - (2.0 * hurst_exponent + 2.0)).abs() < 0.25, "{beta} for {hurst_exponent}");
            let found = hurst(&grid).unwrap();
            assert!((found - hurst_exponent).abs() < 0.12, "{found} for {hurst_exponent}");
            assert!(bands.windows(2).all(|pair| pair[0].wavelength > pair[1].wavelength));
        }
    }

    #[test]
    fn power_is_that_of_the_land_and_planes_have_none() {
        // White noise of variance s^2 has the density s^2 cell^2 everywhere.
        let window = Window::new(256, 256, 10.0);
        // A linear congruential generator (Knuth's MMIX).
        let mut state = 7u64;
        let mut noise = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f32 / (1u32 << 24) as f32
        };
        let grid = Grid::from_data(window, (0..window.len()).map(|_| noise()).collect()).unwrap();
        for band in spectrum(&grid).iter().filter(|band| band.wavelength < 100.0) {
            assert!((band.power / (100.0 / 12.0) - 1.0).abs() < 0.25, "{band:?}");
        }
        let plane =
            Grid::from_data(Window::new(64, 64, 10.0), (0..4096).map(|k| (k % 64) as f32 * 8.0).collect()).unwrap();
        assert!(spectrum(&plane).iter().all(|band| band.power < 1e-6));
        assert!(spectrum(&Grid::filled(Window::new(15, 90, 1.0), 0.0)).is_empty());
        assert_eq!(hurst(&Grid::filled(Window::new(90, 90, 1.0), 0.0)), None);
    }
}
