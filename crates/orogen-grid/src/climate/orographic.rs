//! Rain over mountains: the linear theory of orographic precipitation.

use super::lattice::Lattice;
use crate::error::Result;
use crate::grid::{Grid, Window};
use crate::parallel;
use crate::progress::Progress;

/// The linear theory of orographic precipitation (Smith and Barstad 2004, J. Atmos. Sci. 61).
///
/// Air that the ground lifts condenses water. The water drifts with the wind while it turns into rain and falls. With
/// the Fourier transform h of the heights and the intrinsic frequency sigma = U k + V l, the transform of the rain is
/// (their equation 49)
///
/// ```text
/// P = Cw i sigma h / ((1 - i m Hw) (1 + i sigma tau_c) (1 + i sigma tau_f))
/// m^2 = (Nm^2 - sigma^2) / sigma^2 (k^2 + l^2)
/// ```
///
/// where m has the sign of sigma if it is real, and is positive imaginary otherwise. Coriolis force is neglected.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct OrographicRain {
    /// Wind speed, in m/s; not negative. Default: 15.
    pub wind_speed: f64,
    /// Direction that the wind comes from, in degrees clockwise from north. Default: 270, from the west.
    pub wind_direction: f64,
    /// Nm: moist stability frequency, in 1/s; not negative. Default: 0.005.
    pub stability: f64,
    /// tau_c: time in which cloud water turns into rain and snow, in s; not negative. Default: 1000.
    pub conversion_time: f64,
    /// tau_f: time in which rain and snow fall to the ground, in s; not negative. Default: 1000.
    pub fallout_time: f64,
    /// Hw: scale height of water vapour, in m; not negative. Default: 2500.
    pub vapor_height: f64,
    /// Cw: condensed water for each m^3 of lifted air and metre of lifting, in kg/m^3. Default: 0.004.
    pub uplift_sensitivity: f64,
    /// Rain where the ground is level, in mm per year. Default: 800.
    pub background: f64,
    /// Hours of rain in a year, which convert the rate in mm/h of the theory to the rain of a year. Default: 1000.
    pub rain_hours: f64,
}

impl Default for OrographicRain {
    fn default() -> OrographicRain {
        OrographicRain {
            wind_speed: 15.0,
            wind_direction: 270.0,
            stability: 0.005,
            conversion_time: 1000.0,
            fallout_time: 1000.0,
            vapor_height: 2500.0,
            uplift_sensitivity: 0.004,
            background: 800.0,
            rain_hours: 1000.0,
        }
    }
}

orogen_noise::builder!(
    OrographicRain:
    with_wind_speed(wind_speed: f64),
    with_wind_direction(wind_direction: f64),
    with_stability(stability: f64),
    with_conversion_time(conversion_time: f64),
    with_fallout_time(fallout_time: f64),
    with_vapor_height(vapor_height: f64),
    with_uplift_sensitivity(uplift_sensitivity: f64),
    with_background(background: f64),
    with_rain_hours(rain_hours: f64)
);

/// Seconds in an hour. 1 kg/(m^2 s) is 1 mm/s.
const SECONDS: f64 = 3600.0;

/// Distance beyond the heights over which they are faded, in units of the distance that the wind covers in both times.
const REACH: f64 = 4.0;

impl OrographicRain {
    /// The wind, in m/s to the east and to the south.
    fn wind(&self) -> [f64; 2] {
        let (sin, cos) = libm::sincos(self.wind_direction.to_radians());
        [-sin * self.wind_speed, cos * self.wind_speed]
    }

    /// The rain of a year in mm, as a complex number, for a wave of 1 m height with wavenumbers in 1/m to the east and
    /// to the south.
    fn response(&self, wind: [f64; 2], wave: [f64; 2]) -> [f64; 2] {
        let sigma = wind[0] * wave[0] + wind[1] * wave[1];
        // Waves whose crests are parallel to the wind lift no air.
        if sigma.abs() < 1e-12 {
            return [0.0; 2];
        }
        let squared = (self.stability * self.stability - sigma * sigma) / (sigma * sigma)
            * (wave[0] * wave[0] + wave[1] * wave[1]);
        let m = squared.abs().sqrt();
        let dynamics = match squared >= 0.0 {
            true => [1.0, -m.copysign(sigma) * self.vapor_height],
            false => [1.0 + m * self.vapor_height, 0.0],
        };
        let delays = times([1.0, sigma * self.conversion_time], [1.0, sigma * self.fallout_time]);
        let [re, im] = times(dynamics, delays);
        let rate = self.uplift_sensitivity * sigma * SECONDS * self.rain_hours / (re * re + im * im);
        // i / (re + i im) = (im + i re) / (re^2 + im^2).
        [im * rate, re * rate]
    }

    fn lattice(&self, window: &Window) -> Lattice {
        let reach = REACH * self.wind_speed * (self.conversion_time + self.fallout_time);
        Lattice::new(window, reach)
    }

    /// Memory for computing the rain over a window, in bytes, in addition to the heights and the result.
    #[must_use]
    pub fn memory(&self, window: &Window) -> u64 {
        self.lattice(window).memory()
    }

    /// Rain in mm per year over the window of the heights, at least 0.
    ///
    /// Ground below `sea_level` and NaN count as ground at `sea_level`. Beyond each side of the window, heights change
    /// smoothly to those of the opposite side, over at least 4 times the distance that the wind covers in both times,
    /// or the size of the window if that is less. Land that is cut off at a side therefore ends in a gentle slope. The
    /// time is O(n log n), on all threads; the bits do not depend on the number of threads.
    ///
    /// # Errors
    /// If `progress` is cancelled.
    pub fn over(&self, heights: &Grid, sea_level: f32, progress: &Progress) -> Result<Grid> {
        let mut rain = self.perturbation(heights, sea_level, progress)?;
        let background = self.background;
        parallel::for_each(rain.data_mut().chunks_mut(parallel::SAMPLES), |rain| {
            rain.iter_mut().for_each(|rain| *rain = (background + f64::from(*rain)).max(0.0) as f32);
        });
        Ok(rain)
    }

    /// The difference from the background that the ground causes, in mm per year; may be negative.
    fn perturbation(&self, heights: &Grid, sea_level: f32, progress: &Progress) -> Result<Grid> {
        let wind = self.wind();
        let above_sea = |height: f32| if height > sea_level { f64::from(height) - f64::from(sea_level) } else { 0.0 };
        self.lattice(heights.window()).filtered(heights, above_sea, |wave| self.response(wind, wave), progress)
    }
}

/// The product of two complex numbers.
fn times(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn made(window: Window, height: impl Fn(f64, f64) -> f64) -> Grid {
        let mut grid = Grid::filled(window, 0.0f32);
        for j in 0..window.height {
            for i in 0..window.width {
                grid[(i, j)] = height(window.east(i), window.south(j)) as f32;
            }
        }
        grid
    }

    fn perturbation(law: &OrographicRain, heights: &Grid) -> Grid {
        law.perturbation(heights, 0.0, &Progress::none()).unwrap()
    }

    /// A ridge that runs from north to south.
    const RIDGE: Window = Window { x: -1000, y: 0, width: 2001, height: 9, cell: 500.0 };

    /// The rain of an infinitely long ridge as the integral over its waves, without a discrete transform. `spectrum` is
    /// the integral of h(x) cos(k x) over all x, for a ridge that is symmetric about 0.
    fn integral(law: &OrographicRain, x: f64, spectrum: impl Fn(f64) -> f64) -> f64 {
        let (step, mut sum) = (2e-8, 0.0);
        for n in 0..100_000 {
            let k = (f64::from(n) + 0.5) * step;
            let [re, im] = law.response(law.wind(), [k, 0.0]);
            sum += spectrum(k) * (re * libm::cos(k * x) - im * libm::sin(k * x));
        }
        sum * step / PI
    }

    fn agrees(law: &OrographicRain, heights: &Grid, expected: impl Fn(f64) -> f64, tolerance: f64) {
        let rain = perturbation(law, heights);
        let highest = rain.data().iter().copied().fold(0.0f32, f32::max);
        let off = |i: usize| (f64::from(rain[(i, 4)]) - expected(RIDGE.east(i))).abs() / f64::from(highest);
        let largest = (800..=1200).step_by(5).map(off).fold(0.0, f64::max);
        assert!(largest < tolerance, "differs by {largest} of {highest} mm");
    }

    #[test]
    fn a_gaussian_ridge_has_the_rain_of_its_integral() {
        for half in [5e3, 15e3] {
            let heights = made(RIDGE, |x, _| 500.0 * libm::exp(-x * x / (2.0 * half * half)));
            let spectrum = |k: f64| 500.0 * half * (2.0 * PI).sqrt() * libm::exp(-k * k * half * half / 2.0);
            for law in [OrographicRain::default(), OrographicRain::default().with_stability(0.012).with_wind_speed(8.0)]
            {
                agrees(&law, &heights, |x| integral(&law, x, spectrum), 0.005);
            }
        }
    }

    #[test]
    fn a_ridge_without_delays_has_the_closed_form() {
        // A hydrostatic witch of Agnesi, h = H a^2 / (x^2 + a^2): P = Cw U (h' - s H a (a^2 - x^2) / (x^2 + a^2)^2) /
        // (1 + s^2), s = Nm Hw / U.
        let law = OrographicRain::default().with_conversion_time(0.0).with_fallout_time(0.0).with_stability(0.012);
        let (high, a) = (500.0, 40e3);
        let s = law.stability * law.vapor_height / law.wind_speed;
        let closed = |x: f64| {
            let r = x * x + a * a;
            let uplift = -2.0 * x * high * a * a / (r * r) - s * high * a * (a * a - x * x) / (r * r);
            law.uplift_sensitivity * law.wind_speed * uplift / (1.0 + s * s) * 3600.0 * law.rain_hours
        };
        let heights = made(RIDGE, |x, _| high * a * a / (x * x + a * a));
        agrees(&law, &heights, closed, 0.03);
    }

    #[test]
    fn without_airflow_it_rains_downwind_of_the_lifting() {
        // With Hw = 0 the rain is Cw U h' convolved with the drift of both times, tau_c = tau_f: exp(-t) t.
        let law = OrographicRain::default().with_vapor_height(0.0);
        let half = 10e3;
        let slope = |x: f64| -x / (half * half) * 800.0 * libm::exp(-x * x / (2.0 * half * half));
        let drift = law.wind_speed * law.fallout_time;
        let expected = |x: f64| {
            let part = |n: i32| (f64::from(n) + 0.5) * 0.02;
            let sum: f64 = (0..1000).map(|n| slope(x - drift * part(n)) * libm::exp(-part(n)) * part(n) * 0.02).sum();
            law.uplift_sensitivity * law.wind_speed * sum * 3600.0 * law.rain_hours
        };
        let heights = made(RIDGE, |x, _| 800.0 * libm::exp(-x * x / (2.0 * half * half)));
        agrees(&law, &heights, expected, 0.01);
    }

    #[test]
    fn a_hill_is_wet_to_windward_and_dry_in_its_lee() {
        let law = OrographicRain::default();
        let window = Window::new(401, 401, 1000.0).at(-200, -200);
        let hill = made(window, |x, y| 1500.0 * libm::exp(-(x * x + y * y) / (2.0 * 15e3 * 15e3)));
        let rain = law.over(&hill, 0.0, &Progress::none()).unwrap();
        assert!(rain[(190, 200)] > 1500.0 && rain[(225, 200)] < 400.0, "{} {}", rain[(190, 200)], rain[(225, 200)]);
        assert!(rain.data().iter().all(|rain| *rain >= 0.0));
        assert!((rain[(20, 40)] - 800.0).abs() < 30.0);
        // The gain on one side equals the loss on the other.
        let change = perturbation(&law, &hill);
        let sum: f64 = change.data().iter().map(|rain| f64::from(*rain)).sum();
        let all: f64 = change.data().iter().map(|rain| f64::from(*rain).abs()).sum();
        assert!(sum.abs() < 0.05 * all, "{sum} of {all}");
    }

    #[test]
    fn the_rain_turns_with_the_wind() {
        let window = Window::new(161, 161, 1000.0).at(-80, -80);
        let hill = made(window, |x, y| 1500.0 * libm::exp(-(x * x + y * y) / (2.0 * 12e3 * 12e3)));
        let from = |direction: f64| perturbation(&OrographicRain::default().with_wind_direction(direction), &hill);
        let west = from(270.0);
        let highest = west.data().iter().copied().fold(0.0f32, f32::max);
        let (north, east, south) = (from(0.0), from(90.0), from(180.0));
        for (i, j) in (0..161).flat_map(|j| (0..161).map(move |i| (i, j))) {
            for (turned, what) in
                [(north[(160 - j, i)], "north"), (east[(160 - i, 160 - j)], "east"), (south[(j, 160 - i)], "south")]
            {
                assert!((turned - west[(i, j)]).abs() < 1e-3 * highest, "{what} at {i} {j}");
            }
        }
        // Between the axes: the rain along the diagonal equals that along the row.
        let southwest = from(225.0);
        for k in 0..40 {
            let (dx, along) = (f64::from(k) * 1000.0, std::f64::consts::SQRT_2);
            let (i, d) = (80 - (dx * along / 1000.0).round() as usize, 80 - k as usize);
            let (a, b) = (west[(i, 80)], southwest[(d, 160 - d)]);
            assert!((a - b).abs() < 0.06 * highest, "{k}: {a} {b}");
        }
    }

    #[test]
    fn the_sea_floor_and_calm_air_make_no_rain_and_threads_no_difference() {
        let window = Window::new(70, 50, 2000.0);
        let floor = made(window, |x, y| 900.0 * libm::sin(x / 9e3) * libm::cos(y / 7e3) - 1000.0);
        let level = OrographicRain::default().over(&floor, 0.0, &Progress::none()).unwrap();
        assert!(level.data().iter().all(|rain| *rain == 800.0));
        let hills = made(window, |x, y| 900.0 * libm::sin(x / 9e3) * libm::cos(y / 7e3) + 100.0);
        let calm = OrographicRain::default().with_wind_speed(0.0).over(&hills, 0.0, &Progress::none()).unwrap();
        assert_eq!(calm.data(), level.data());
        let run = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| perturbation(&OrographicRain::default(), &hills))
        };
        assert!([2, 3, 7].map(run).iter().all(|other| *other == run(1)));
    }

    #[test]
    fn it_stops_when_asked() {
        let progress = Progress::none();
        progress.cancel();
        let hills = Grid::filled(Window::new(40, 40, 1000.0), 100.0);
        assert!(OrographicRain::default().over(&hills, 0.0, &progress).is_err());
    }
}
