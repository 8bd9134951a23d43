//! Soft relief shading: several lights, with a z factor fitted to the steepness of the land.

use orogen_grid::analysis::hillshade::Light;
use orogen_grid::analysis::slope::{Gradient, gradients_between};
use orogen_grid::grid::Grid;

/// The lights: degrees clockwise from north, degrees above the horizon, weight. Ridges parallel to a single light are
/// invisible; the second and third light show them (after R. K. Mark, "Multidirectional, oblique-weighted,
/// shaded-relief image", USGS 1992).
const LIGHTS: [(f64, f64, f32); 3] = [(315.0, 42.0, 0.6), (265.0, 38.0, 0.2), (5.0, 38.0, 0.2)];

/// The lights of the shading.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lights {
    /// One light, from the north-west.
    One,
    /// Three lights, the main one from the north-west: the default.
    Three,
}

/// The steepness (rise over run) that is shaded without exaggeration: the steepness of real mountains at cells of 30 m.
const NATURAL: f32 = 0.65;

/// The exponent by which the steepness is adjusted towards [`NATURAL`]: with 1 hills would look like alps, with 0
/// coarse cells, whose slopes are less steep, would have no visible relief.
const FIT: f32 = 0.66;

/// The brightness of the darkest shadow, and the weight of light above that of level ground.
const DARKEST: f32 = 0.26;
const HIGHLIGHT: f32 = 0.45;

/// Strength of the shading of the sea floor relative to land.
pub(crate) const UNDER_WATER: f32 = 0.35;

/// Strength of the shading on colors of a layer, which must remain readable on a color bar.
pub(crate) const ON_LAYER: f32 = 0.5;

/// Brightness of the printed ground relative to its albedo: paper is viewed in less light than land.
pub const PRINTED: f32 = 1.8;

/// Number of rows that the z factor is fitted to.
pub(crate) const PROBES: usize = 64;

/// A shading: lights and a z factor. Level ground keeps its color; slopes towards the light become brighter, others
/// darker and bluer.
#[derive(Debug, Clone)]
pub struct Shade {
    lights: Vec<(Light, f32)>,
    level: f32,
}

impl Shade {
    /// The shading with heights multiplied by `z_factor`.
    #[must_use]
    pub fn new(z_factor: f32) -> Shade {
        Shade::lit(Lights::Three, z_factor)
    }

    /// The shading with heights multiplied by `z_factor`, and these lights.
    #[must_use]
    pub fn lit(lights: Lights, z_factor: f32) -> Shade {
        let count = if lights == Lights::One { 1 } else { LIGHTS.len() };
        let lights: Vec<(Light, f32)> = LIGHTS[..count]
            .iter()
            .map(|&(azimuth, altitude, weight)| (Light::new(azimuth, altitude, f64::from(z_factor)), weight))
            .collect();
        let level = lights.iter().map(|(light, weight)| weight * light.on_level()).sum();
        Shade { lights, level }
    }

    /// The shading with a z factor fitted to the land of `grid` (or to the sea floor, if there is no land). Steepness
    /// depends on the cell; the fit makes different cells of one world look alike.
    #[must_use]
    pub fn fit(grid: &Grid, sea_level: f32) -> Shade {
        Shade::fit_lit(Lights::Three, grid, sea_level)
    }

    /// Like [`fit`](Shade::fit), with these lights.
    #[must_use]
    pub fn fit_lit(lights: Lights, grid: &Grid, sea_level: f32) -> Shade {
        let typical = typical_steepness(grid, |height| height > sea_level)
            .or_else(|| typical_steepness(grid, |height| height <= sea_level));
        Shade::of_typical(lights, typical)
    }

    /// Like [`fit`](Shade::fit), but fitted to samples, each given as steepness and height, such as the samples of
    /// [`PROBES`] rows.
    pub(crate) fn fit_samples(samples: &[(f32, f32)], sea_level: f32) -> Shade {
        let typical = |is_land: bool| {
            let kind = samples.iter().filter(|(steepness, height)| {
                steepness.is_finite() && height.is_finite() && (*height > sea_level) == is_land
            });
            exceeded_by_a_quarter(kind.map(|(steepness, _)| *steepness).collect())
        };
        Shade::of_typical(Lights::Three, typical(true).or_else(|| typical(false)))
    }

    /// The shading of ground with this typical steepness.
    fn of_typical(lights: Lights, typical: Option<f32>) -> Shade {
        let z_factor = match typical {
            Some(steepness) if steepness > 0.0 => libm::powf(NATURAL / steepness, FIT),
            _ => 1.0,
        };
        Shade::lit(lights, z_factor)
    }

    /// Factors for the red, green and blue light of a color.
    #[must_use]
    pub fn on(&self, gradient: Gradient) -> [f32; 3] {
        let light: f32 = self.lights.iter().map(|(light, weight)| weight * light.on(gradient)).sum();
        let relative = light / self.level;
        if relative >= 1.0 {
            [1.0 + (relative - 1.0) * HIGHLIGHT; 3]
        } else {
            let factor = DARKEST + (1.0 - DARKEST) * relative;
            // Shadows are lit by the sky: they keep some blue and lose red first.
            let dark = 1.0 - factor;
            [factor - 0.07 * dark, factor, factor + 0.10 * dark]
        }
    }
}

/// The steepness exceeded by a quarter of the samples of `kind`, estimated from some rows; `None` if there are too few.
fn typical_steepness(grid: &Grid, kind: impl Fn(f32) -> bool) -> Option<f32> {
    if grid.height() < 3 || grid.width() < 3 {
        return None;
    }
    let inner = grid.height() - 2;
    let mut found = Vec::new();
    for j in (0..inner).step_by(inner.div_ceil(PROBES)) {
        gradients_between([grid.row(j), grid.row(j + 1), grid.row(j + 2)], grid.window().cell, |i, gradient| {
            let steepness = gradient.steepness();
            if steepness.is_finite() && kind(grid[(i + 1, j + 1)]) {
                found.push(steepness);
            }
        });
    }
    exceeded_by_a_quarter(found)
}

/// The number that is exceeded by a quarter of `found`; `None` if it is empty.
fn exceeded_by_a_quarter(mut found: Vec<f32>) -> Option<f32> {
    let at = found.len() * 3 / 4;
    (!found.is_empty()).then(|| *found.select_nth_unstable_by(at, f32::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_grid::grid::Window;

    /// Long waves of `steepness` at most, running south-west to north-east.
    fn waves(cell: f64, steepness: f64) -> Grid {
        let window = Window::new(200, 100, cell);
        let mut grid = Grid::filled(window, 0.0);
        for j in 0..100 {
            for i in 0..200 {
                let phase = (window.east(i) + window.south(j)) / 1000.0;
                grid.row_mut(j)[i] = (2000.0 + libm::sin(phase) * 1000.0 * steepness) as f32;
            }
        }
        grid
    }

    /// The lowest and the highest factor of green at inner samples.
    fn range(grid: &Grid) -> (f32, f32) {
        let shade = Shade::fit(grid, 0.0);
        let mut range = (f32::INFINITY, 0.0f32);
        for j in 0..grid.height() - 2 {
            gradients_between([grid.row(j), grid.row(j + 1), grid.row(j + 2)], grid.window().cell, |_, gradient| {
                let factor = shade.on(gradient)[1];
                range = (range.0.min(factor), range.1.max(factor));
            });
        }
        range
    }

    #[test]
    fn level_ground_keeps_its_color() {
        for z_factor in [0.1, 1.0, 30.0] {
            let factors = Shade::new(z_factor).on(Gradient { east: 0.0, north: 0.0 });
            assert!(factors.iter().all(|f| (f - 1.0).abs() < 1e-6));
        }
        assert_eq!(range(&Grid::filled(Window::new(9, 9, 1.0), 5.0)), (1.0, 1.0));
    }

    #[test]
    fn gentle_and_steep_worlds_both_show_and_keep_their_order() {
        let contrast: Vec<f32> = [0.02, 0.1, 0.5, 2.0]
            .map(|steepness| {
                let (low, high) = range(&waves(30.0, steepness));
                assert!(low < 0.93 && high > 1.01 && low >= DARKEST, "{steepness}: {low} {high}");
                high - low
            })
            .to_vec();
        assert!(contrast.is_sorted(), "{contrast:?}");
    }

    #[test]
    fn samples_of_all_rows_fit_like_their_grid() {
        let grid = waves(30.0, 0.2);
        let mut samples = Vec::new();
        for j in 0..grid.height() - 2 {
            gradients_between([grid.row(j), grid.row(j + 1), grid.row(j + 2)], 30.0, |i, gradient| {
                samples.push((gradient.steepness(), grid[(i + 1, j + 1)]));
            });
        }
        samples.extend([(f32::NAN, 2000.0), (9.0, f32::NAN)]);
        let on = |shade: Shade| shade.on(Gradient { east: 0.1, north: 0.05 })[1];
        let [whole, sampled] = [on(Shade::fit(&grid, 0.0)), on(Shade::fit_samples(&samples, 0.0))];
        assert!((whole - sampled).abs() < 0.01 && whole != on(Shade::new(1.0)), "{whole} {sampled}");
        // Without land, the shading is fitted to the sea floor; without either, it is not fitted.
        assert_eq!(on(Shade::fit_samples(&samples, 9000.0)), sampled);
        assert_eq!(on(Shade::fit_samples(&[], 0.0)), on(Shade::new(1.0)));
    }

    #[test]
    fn the_cell_matters_little() {
        let (fine, coarse) = (range(&waves(15.0, 0.5)), range(&waves(60.0, 0.5)));
        assert!((fine.0 - coarse.0).abs() < 0.05 && (fine.1 - coarse.1).abs() < 0.05, "{fine:?} {coarse:?}");
    }

    #[test]
    fn missing_samples_are_merely_dark() {
        let factors = Shade::new(1.0).on(Gradient { east: f32::NAN, north: 0.0 });
        assert!(factors.iter().all(|&f| f > 0.0 && f < 0.5), "{factors:?}");
    }
}
