//! Indices from drainage area and slope.

use super::accumulation::Accumulation;
use crate::analysis::slope::{extended, steepness};
use crate::grid::Grid;

/// The minimum slope, which avoids an infinite wetness on level ground.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct LevelGround {
    /// The minimum slope, rise over run.
    pub least_slope: f64,
}

orogen_noise::builder!(LevelGround: with_least_slope(least_slope: f64));

impl Default for LevelGround {
    fn default() -> LevelGround {
        LevelGround { least_slope: 1e-3 }
    }
}

impl LevelGround {
    /// The slope, raised to the minimum if it is less; NaN stays NaN.
    #[must_use]
    pub fn slope(&self, slope: f32) -> f64 {
        let slope = f64::from(slope);
        if slope < self.least_slope { self.least_slope } else { slope }
    }
}

/// The topographic wetness index ln(a / tan b) (Beven and Kirkby 1979) of a specific catchment area in metres and a
/// slope in rise over run.
#[must_use]
pub fn wetness_index(area: f64, slope: f64) -> f64 {
    libm::log(area / slope)
}

/// The stream power index a tan b (Moore, Grayson and Ladson 1991), in metres, of a specific catchment area in metres
/// and a slope in rise over run.
#[must_use]
pub fn stream_power(area: f64, slope: f64) -> f64 {
    area * slope
}

/// The LS factor 1.4 (a / 22.13)^0.4 (sin b / 0.0896)^1.3 (Moore and Burch, "Physical basis of the length-slope factor
/// in the universal soil loss equation", 1986): soil loss relative to a slope of 22.13 m and 9 %. `area` is in metres,
/// `slope` is rise over run.
#[must_use]
pub fn ls_factor(area: f64, slope: f64) -> f64 {
    let sine = slope / (1.0 + slope * slope).sqrt();
    1.4 * libm::pow(area / 22.13, 0.4) * libm::pow(sine / 0.0896, 1.3)
}

/// The topographic wetness index of a whole map, with slopes by Horn's method (one-sided at the border). High values
/// mean a large catchment and level ground. Slopes below 0.001 count as 0.001. NaN where a sample is missing.
#[must_use]
pub fn wetness(heights: &Grid, drained: &Accumulation) -> Grid {
    wetness_of_rows(heights, &drained.area)
}

/// [`wetness`] for some rows of a map with known areas, in cells. `around` has one more row on each side where the map
/// has one.
#[must_use]
pub fn wetness_of_rows(around: &Grid, areas: &Grid<u32>) -> Grid {
    let steep = steepness(&extended(around));
    let mut out = steep.crop(areas.window()).unwrap_or(steep);
    let (cell, level) = (around.window().cell, LevelGround::default());
    for (value, cells) in out.data_mut().iter_mut().zip(areas.data()) {
        *value = wetness_index(f64::from(*cells) * cell, level.slope(*value)) as f32;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Window;
    use crate::hydrology::accumulation::accumulate;
    use crate::hydrology::drainage;
    use crate::hydrology::outlets::Outlets;
    use crate::hydrology::steepest::Descent;

    #[test]
    fn it_is_the_logarithm_on_a_plane() {
        let mut plane = Grid::filled(Window::new(12, 6, 20.0), 0.0);
        for j in 0..6 {
            for i in 0..12 {
                plane.row_mut(j)[i] = 100.0 - 2.0 * i as f32;
            }
        }
        plane.row_mut(0)[0] = f32::NAN;
        let outlets = Outlets::new(&plane, None);
        let drained = accumulate(&drainage::route_carving(&plane, &outlets, Descent::Steepest).receivers);
        let wet = wetness(&plane, &drained);
        // Ten cells from the west, each 20 m wide, on a slope of 1 in 10.
        let expect = libm::log(f64::from(drained.area[(10, 3)]) * 20.0 / 0.1) as f32;
        assert!((wet[(10, 3)] - expect).abs() < 1e-3 && drained.area[(10, 3)] >= 8);
        assert!(wet[(0, 0)].is_nan() && wet.window() == plane.window());
        let level = Grid::filled(Window::new(5, 5, 1.0), 3.0);
        let drained =
            accumulate(&drainage::route_carving(&level, &Outlets::new(&level, None), Descent::Steepest).receivers);
        assert!(wetness(&level, &drained).data().iter().all(|v| v.is_finite()));
    }
}
