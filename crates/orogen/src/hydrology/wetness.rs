//! The topographic wetness index.

use super::accumulation::Accumulation;
use crate::analysis::slope::{extended, steepness};
use crate::grid::Grid;

/// ln(a / tan b) (Beven and Kirkby 1979): a is the drainage area over the cell's width in metres, tan b the slope by Horn's
/// method, at the grid's border one-sided. High where much water comes to level ground. Slopes below 1 in 1000 count as that, or
/// level ground would be infinitely wet. NaN where a sample is missing.
pub fn wetness(heights: &Grid, drained: &Accumulation) -> Grid {
    let mut out = steepness(&extended(heights));
    let cell = heights.window().cell;
    for (value, cells) in out.data_mut().iter_mut().zip(drained.area.data()) {
        let slope = f64::from(*value).max(1e-3);
        // `max` would hide a missing slope.
        *value = if value.is_nan() { f32::NAN } else { libm::log(f64::from(*cells) * cell / slope) as f32 };
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
        let drained = accumulate(&drainage::over_bed(&plane, &outlets, Descent::Steepest).receivers);
        let wet = wetness(&plane, &drained);
        // Ten cells from the west, each 20 m wide, on a slope of 1 in 10.
        let expect = libm::log(f64::from(drained.area.get(10, 3)) * 20.0 / 0.1) as f32;
        assert!((wet.get(10, 3) - expect).abs() < 1e-3 && drained.area.get(10, 3) >= 8);
        assert!(wet.get(0, 0).is_nan() && wet.window() == plane.window());
        let level = Grid::filled(Window::new(5, 5, 1.0), 3.0);
        let drained = accumulate(&drainage::over_bed(&level, &Outlets::new(&level, None), Descent::Steepest).receivers);
        assert!(wetness(&level, &drained).data().iter().all(|v| v.is_finite()));
    }
}
