//! Hillshade: the illumination of slopes by a distant light.
//!
//! With the light's azimuth a (degrees clockwise from north), its zenith angle z, the slope s and the aspect b, the
//! hillshade is `cos z cos s + sin z sin s cos(a - b)`, clamped to 0 (Horn 1981). With the gradient (p, q) and the z
//! factor k this is the product of the light's direction and the surface's normal:
//!
//! ```text
//! (L_up - k (p L_east + q L_north)) / sqrt(1 + k^2 (p^2 + q^2))
//! ```
//!
//! This form computes no angle per sample. 1 is full illumination; level ground gets the sine of the altitude. A
//! missing sample gives 0.

use super::slope::{Gradient, inner, values_between};
use crate::grid::Grid;

/// The direction of the light, prepared for evaluation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Light {
    east: f32,
    north: f32,
    up: f32,
    z_factor: f32,
}

impl Default for Light {
    /// Light from the north-west at 45 degrees altitude, z factor 1.
    fn default() -> Light {
        Light::new(315.0, 45.0, 1.0)
    }
}

impl Light {
    /// Light from `azimuth` degrees (clockwise from north) and `altitude` degrees above the horizon; heights are
    /// multiplied by `z_factor`.
    #[must_use]
    pub fn new(azimuth: f64, altitude: f64, z_factor: f64) -> Light {
        let (azimuth, altitude) = (azimuth.to_radians(), altitude.to_radians());
        Light {
            east: (libm::sin(azimuth) * libm::cos(altitude)) as f32,
            north: (libm::cos(azimuth) * libm::cos(altitude)) as f32,
            up: libm::sin(altitude) as f32,
            z_factor: z_factor as f32,
        }
    }

    /// The illumination of ground with this gradient, 0 to 1; 0 if the gradient is NaN.
    #[inline(always)]
    #[must_use]
    pub fn on(&self, gradient: Gradient) -> f32 {
        let (p, q) = (self.z_factor * gradient.east, self.z_factor * gradient.north);
        let light = self.toward(p, q) / (1.0 + p * p + q * q).sqrt();
        // Written so that NaN also gives 0.
        let light = if light > 0.0 { light } else { 0.0 };
        if light < 1.0 { light } else { 1.0 }
    }

    /// The direction to the light (east, north and up) and the z factor, for other renderers.
    #[doc(hidden)]
    #[must_use]
    pub fn numbers(&self) -> [f32; 4] {
        [self.east, self.north, self.up, self.z_factor]
    }

    /// The illumination of level ground.
    #[must_use]
    pub fn on_level(&self) -> f32 {
        self.up
    }

    #[inline(always)]
    fn toward(&self, p: f32, q: f32) -> f32 {
        self.up - p * self.east - q * self.north
    }
}

/// The hillshade, 0 to 1, of every sample of `grid` except its border of one sample.
#[must_use]
pub fn hillshade(grid: &Grid, light: &Light) -> Grid {
    let window = inner(grid.window());
    let mut out = Grid::filled(window, 0.0);
    for j in 0..window.height {
        hillshade_between([grid.row(j), grid.row(j + 1), grid.row(j + 2)], window.cell, light, out.row_mut(j));
    }
    out
}

/// The hillshade of the inner samples of three adjacent rows, from the north. `out` is shorter than the rows by two.
pub fn hillshade_between(rows: [&[f32]; 3], cell: f64, light: &Light, out: &mut [f32]) {
    let light = *light;
    values_between(rows, cell, out, move |gradient| light.on(gradient));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Window;

    /// The textbook formula with angles, in f64.
    fn by_angles(east: f64, north: f64, azimuth: f64, altitude: f64, z_factor: f64) -> f64 {
        let (p, q) = (east * z_factor, north * z_factor);
        let zenith = (90.0 - altitude).to_radians();
        let slope = libm::atan(libm::sqrt(p * p + q * q));
        // The aspect is the direction that the slope faces: downhill, clockwise from north.
        let aspect = libm::atan2(-p, -q);
        let light = libm::cos(zenith) * libm::cos(slope)
            + libm::sin(zenith) * libm::sin(slope) * libm::cos(azimuth.to_radians() - aspect);
        light.max(0.0)
    }

    #[test]
    fn it_is_the_textbooks_within_a_hundredth_of_a_grey_level() {
        for azimuth in [0.0, 45.0, 100.0, 225.0, 315.0] {
            for altitude in [5.0, 30.0, 45.0, 90.0] {
                for step in 0..50 {
                    let (east, north) = (f64::from(step * 7 % 50) * 0.1 - 2.5, f64::from(step * 11 % 50) * 0.1 - 2.5);
                    let light = Light::new(azimuth, altitude, 1.5);
                    let got = light.on(Gradient { east: east as f32, north: north as f32 });
                    let expect = by_angles(east, north, azimuth, altitude, 1.5);
                    assert!((f64::from(got) - expect).abs() < 0.01 / 255.0, "{azimuth} {altitude} {east} {north}");
                }
            }
        }
    }

    #[test]
    fn the_north_west_is_bright_and_the_south_east_dark() {
        // A cone: its north-west side faces the light.
        let window = Window::new(21, 21, 10.0).at(-10, -10);
        let mut cone = Grid::filled(window, 0.0);
        for j in 0..21 {
            for i in 0..21 {
                let (x, y) = (window.east(i), window.south(j));
                cone.row_mut(j)[i] = (500.0 - (x * x + y * y).sqrt()) as f32;
            }
        }
        let shade = hillshade(&cone, &Light::default());
        let (north_west, south_east) = (shade[(3, 3)], shade[(15, 15)]);
        assert!((north_west - 1.0).abs() < 0.01 && south_east < 0.01, "{north_west} {south_east}");
        let level = hillshade(&Grid::filled(window, 7.0), &Light::default());
        assert!(level.data().iter().all(|&v| (v - 0.5f32.sqrt()).abs() < 1e-6));
    }

    #[test]
    fn rows_with_and_without_missing_samples_are_the_same_where_they_do_not_look_at_one() {
        let window = Window::new(40, 9, 3.0);
        let mut sound = Grid::filled(window, 0.0);
        for (k, height) in sound.data_mut().iter_mut().enumerate() {
            *height = (k * k % 61) as f32 * 0.3;
        }
        let mut holed = sound.clone();
        (holed.row_mut(4)[10], holed.row_mut(1)[30]) = (f32::NAN, f32::INFINITY);
        let [sound, holed] = [sound, holed].map(|grid| hillshade(&grid, &Light::default()));
        for (j, i) in (0..7).flat_map(|j| (0..38).map(move |i| (j, i))) {
            let near = |y: i32, x: i32| (j + 1 - y).abs() <= 1 && (i + 1 - x).abs() <= 1;
            if !near(4, 10) && !near(1, 30) {
                assert_eq!(sound[(i as usize, j as usize)], holed[(i as usize, j as usize)], "({i}, {j})");
            }
        }
        assert_eq!((holed[(9, 3)], holed[(29, 0)]), (0.0, 0.0));
    }

    #[test]
    fn missing_samples_are_dark() {
        let light = Light::default();
        assert_eq!(light.on(Gradient { east: f32::NAN, north: 0.0 }), 0.0);
        assert_eq!(light.on(Gradient { east: f32::MAX, north: f32::MAX }), 0.0);
    }
}
