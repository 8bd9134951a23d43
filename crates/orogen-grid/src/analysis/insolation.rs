//! Insolation over days: direct, diffuse and reflected light, with cast shadows.

use crate::parallel;

use super::clear_sky::{ClearSky, Facet, Sunlight};
use super::halo::Halo;
use super::shadow::Shadows;
use super::slope::gradients_between;
use super::sun::Moment;
use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::progress::Progress;

/// A period of days, and the latitude.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Period {
    /// Latitude in degrees north.
    pub latitude: f64,
    /// The first and the last day, 1 to 365. If the first is after the last, the period includes the turn of the year.
    pub days: [u16; 2],
    /// The longest time step within a day, in hours.
    pub step: f64,
}

impl Period {
    /// The given days at a latitude in degrees north, with time steps of half an hour.
    #[must_use]
    pub const fn new(latitude: f64, days: [u16; 2]) -> Period {
        Period { latitude, days, step: 0.5 }
    }
}

orogen_noise::builder!(Period: with_latitude(latitude: f64), with_days(days: [u16; 2]), with_step(step: f64));

/// Maximum number of days that one sampled day represents.
const DAYS: usize = 30;

/// Number of suns whose shadows are in memory at a time.
const AT_ONCE: usize = 8;

impl Period {
    /// The sampled days: the middles of equal parts of the period.
    fn sampled_days(&self) -> Vec<u16> {
        let [first, last] = self.days.map(usize::from);
        let length = if last >= first { last - first + 1 } else { last + 365 - first + 1 };
        let parts = length.div_ceil(DAYS);
        (0..parts).map(|k| ((first - 1 + (2 * k + 1) * length / (2 * parts)) % 365 + 1) as u16).collect()
    }

    /// The suns of the period above the horizon, with the hours of an average day that each represents.
    fn suns(&self, sky: &ClearSky, heights: [f64; 2]) -> Vec<(Sunlight, f64)> {
        let days = self.sampled_days();
        let mut suns = Vec::new();
        for day in &days {
            let moment = |hour: f64| Moment { latitude: self.latitude, day: *day, hour };
            let Some([rise, set]) = moment(12.0).daylight() else { continue };
            let steps = ((set - rise) / self.step).ceil().max(1.0);
            let hours = (set - rise) / steps;
            for k in 0..steps as usize {
                let sun = moment(rise + (k as f64 + 0.5) * hours).sun();
                if sun[1] > 0.0 {
                    suns.push((sky.sunlight(f64::from(*day), sun, heights), hours / days.len() as f64));
                }
            }
        }
        suns
    }
}

/// The insolation of each sample on an average day of the period, in kWh/m^2. Slopes use Horn's method. Outside the
/// grid, heights are extrapolated linearly and cast no shadow.
///
/// The sun is sampled at the middle of each time step from sunrise to sunset, on at least one day in 30. Needs 16 bytes
/// per sample in addition to the heights. The time is O(samples) per position of the sun.
///
/// # Errors
/// If `progress` is cancelled.
pub fn insolation(heights: &Grid, period: &Period, sky: &ClearSky, progress: &Progress) -> Result<Grid> {
    let window = *heights.window();
    let mut out = Grid::filled(window, 0.0f32);
    if window.is_empty() {
        return Ok(out);
    }
    let ends = heights
        .data()
        .iter()
        .filter(|h| h.is_finite())
        .fold([f32::INFINITY, f32::NEG_INFINITY], |ends, h| [ends[0].min(*h), ends[1].max(*h)]);
    let ends = if ends[0] <= ends[1] { ends.map(f64::from) } else { [0.0, 0.0] };
    let beyond = Halo::default();
    let shadows = Shadows::new(heights.data(), window.width, window.cell);
    let suns = period.suns(sky, ends);
    // Shadows take about as long as the irradiance.
    progress.expect(2.0 * suns.len() as f64);
    for suns in suns.chunks(AT_ONCE) {
        let lit = parallel::try_map(suns, |(sun, _)| {
            let lit = shadows.lit_by_rows(sun.towards, &|| progress.check())?;
            progress.advance(1.0);
            Ok::<Vec<bool>, Error>(lit)
        })?;
        progress.check()?;
        let work = suns.len() as f64 / window.height as f64;
        let rows = out.data_mut().chunks_mut(window.width).enumerate();
        parallel::try_for_each_init(rows, Vec::new, |wide, (j, row)| {
            progress.step(work)?;
            gradients_between(beyond.rows(heights, j, wide), window.cell, |i, gradient| {
                let facet = Facet::new(f64::from(gradient.east), -f64::from(gradient.north));
                let at = j * window.width + i;
                let height = f64::from(heights.data()[at]);
                let of = |((sun, hours), lit): (&(Sunlight, f64), &Vec<bool>)| sun.on(&facet, height, lit[at]) * hours;
                row[i] += (suns.iter().zip(&lit).map(of).sum::<f64>() * 1e-3) as f32;
            });
            Ok::<(), Error>(())
        })?;
    }
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Window;

    const SKY: ClearSky = ClearSky { turbidity: 3.0, albedo: 0.2 };

    fn made(period: &Period, f: impl Fn(usize, usize) -> f32) -> Grid {
        let data = (0..40 * 40).map(|k| f(k % 40, k / 40)).collect();
        let heights = Grid::from_data(Window::new(40, 40, 30.0), data).unwrap();
        insolation(&heights, period, &SKY, &Progress::none()).unwrap()
    }

    #[test]
    fn twelve_days_and_half_hours_stand_for_a_year() {
        let year = Period { latitude: 46.0, days: [1, 365], step: 0.5 };
        assert_eq!(year.sampled_days().len(), 13);
        for slope in [0.0, 12.0, -12.0] {
            let coarse = made(&year, |_, y| slope * y as f32)[(20, 20)];
            let sum: f32 = (1..=365)
                .step_by(4)
                .map(|day| {
                    let day = Period { days: [day, day], step: 0.1, ..year };
                    let suns = day.suns(&SKY, [-480.0, 480.0]);
                    let facet = Facet::new(0.0, f64::from(slope) / 30.0);
                    let height = f64::from(20.0 * slope);
                    suns.iter().map(|(sun, hours)| sun.on(&facet, height, true) * hours).sum::<f64>() as f32 / 1000.0
                })
                .sum();
            let fine = sum / 92.0;
            assert!((coarse / fine - 1.0).abs() < 0.01, "{slope}: {coarse} {fine}");
        }
    }

    #[test]
    fn a_tenth_of_an_hour_is_enough_for_a_day_in_the_mountains() {
        // Peaks 700 m high and 450 m apart, with long shadows that cross narrow valleys.
        let peaks = |x: usize, y: usize| {
            let [x, y] = [x as f64 * 0.42, y as f64 * 0.39];
            (350.0 * (libm::sin(x) * libm::cos(y) + 0.5 * libm::sin(1.7 * x + 2.3 * y))) as f32
        };
        let day = |step: f64| made(&Period { latitude: 46.0, days: [355, 355], step }, peaks);
        let fine = day(0.01);
        let off = |step: f64| {
            let coarse = day(step);
            let pairs = coarse.data().iter().zip(fine.data());
            pairs.map(|(coarse, fine)| f64::from((coarse / fine - 1.0).abs())).sum::<f64>() / fine.data().len() as f64
        };
        let (tenth, half) = (off(0.1), off(0.5));
        assert!(tenth < 0.01 && half > 2.0 * tenth, "{tenth} {half}");
    }

    #[test]
    fn days_are_in_the_middle_and_run_over_the_turn_of_the_year() {
        let days = |days| Period { latitude: 0.0, days, step: 0.5 }.sampled_days();
        assert_eq!(days([172, 172]), [172]);
        assert_eq!(days([1, 60]), [16, 46]);
        assert_eq!(days([351, 20]), [359, 12]);
        assert_eq!(days([340, 35]), [350, 5, 25]);
    }

    #[test]
    fn there_is_no_light_in_polar_night_and_less_behind_a_wall() {
        let night = Period { latitude: 80.0, days: [355, 355], step: 0.5 };
        assert!(made(&night, |_, _| 0.0).data().iter().all(|light| *light == 0.0));
        let winter = Period { latitude: 46.0, days: [355, 355], step: 0.5 };
        let open = made(&winter, |_, _| 0.0)[(20, 20)];
        // A wall to the south that hides the sun even at noon.
        let behind = made(&winter, |_, y| if y > 24 { 300.0 } else { 0.0 })[(20, 20)];
        assert!(behind < 0.4 * open && behind > 0.05 * open, "{behind} {open}");
    }
}
