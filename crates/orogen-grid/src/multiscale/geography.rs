//! The locations of land and sea, ranges and plains: noises with wavelengths of hundreds of kilometres.

use super::continents::Continents;
use super::gradient_noise::{noise, smooth_step};
use super::hash;

/// The noises at a position.
pub struct Geography {
    seed: u64,
    /// Shape of the coast below which a position is in the sea.
    threshold: f64,
    /// Factor from metres to kilometres of the noises.
    scale: f64,
    /// The position in the noises that is at the origin of the world, in kilometres.
    home: (f64, f64),
}

/// Number of positions that are tried as the home.
const PLACES: u64 = 64;

/// Requirements for a home, which is in mountains near the sea: distance to the shore in kilometres, and logarithm of
/// uplift over erodibility.
const HOME_SHORE: std::ops::Range<f32> = 60.0..400.0;
const HOME_UPLIFT: f32 = 0.3;

/// The threshold of the coast by share of land, in steps of 0.1 from 0 to 1: measured quantiles of [`Site::coast`]
/// including its detail.
const THRESHOLDS: [f64; 11] = [0.72, 0.46, 0.305, 0.19, 0.09, 0.0, -0.09, -0.19, -0.305, -0.46, -0.72];

/// Kilometres of distance to the shore per unit of the shape of the coast.
const COAST: f64 = 1500.0;

/// The warped coordinates of a position, in kilometres. Three of them are rotated, so that the lattices of the noises
/// differ.
struct Site<'a> {
    geography: &'a Geography,
    plain: (f64, f64),
    warped: (f64, f64),
    turned: [(f64, f64); 3],
}

impl Geography {
    pub fn new(land: &Continents) -> Geography {
        let place = land.land * 10.0;
        let below = (place as usize).min(9);
        let share = place - below as f64;
        let threshold = THRESHOLDS[below] * (1.0 - share) + THRESHOLDS[below + 1] * share;
        let geography = Geography { seed: land.refinement.seed, threshold, scale: 0.001 / land.size, home: (0.0, 0.0) };
        Geography { home: geography.found_home(), ..geography }
    }

    /// Returns a position in mountains near the sea, or else the position on land with the largest uplift, so that the
    /// land around the origin is interesting with every seed.
    fn found_home(&self) -> (f64, f64) {
        let mut best = (f32::NEG_INFINITY, (0.0, 0.0));
        for place in 0..PLACES {
            let draw = |shift: u32| f64::from(hash::unit(hash::node(self.seed, 0, place as i64, 0, 6) << shift));
            let at = (4e4 * draw(0), 4e4 * draw(24));
            let (x, y) = (at.0 / self.scale, at.1 / self.scale);
            if !HOME_SHORE.contains(&self.shore(x, y)) {
                continue;
            }
            let uplift = self.uplift(x, y);
            if uplift >= HOME_UPLIFT {
                return at;
            }
            if uplift > best.0 {
                best = (uplift, at);
            }
        }
        best.1
    }

    fn noise(&self, stream: u64, wavelength: f64, (x, y): (f64, f64)) -> f64 {
        let offset = stream as f64;
        noise(self.seed, stream, x / wavelength + 0.37 * offset, y / wavelength - 0.61 * offset)
    }

    /// The position (x, y) in metres, with warped coordinates.
    fn site(&self, x: f64, y: f64) -> Site<'_> {
        let plain = (x * self.scale + self.home.0, y * self.scale + self.home.1);
        let shift = |first, second| 420.0 * self.noise(first, 1700.0, plain) + 130.0 * self.noise(second, 520.0, plain);
        let warped = (plain.0 + shift(1, 3), plain.1 + shift(2, 4));
        let turn = |(x, y): (f64, f64)| (0.8 * x - 0.6 * y, 0.6 * x + 0.8 * y);
        let once = turn(warped);
        let twice = turn(once);
        Site { geography: self, plain, warped, turned: [once, twice, turn(twice)] }
    }

    /// The approximate distance to the shore in kilometres, positive on land, at (x, y) in metres.
    pub fn shore(&self, x: f64, y: f64) -> f32 {
        let site = self.site(x, y);
        let [_, _, thrice] = site.turned;
        let detail = 0.2 * self.noise(8, 700.0, thrice) + 0.13 * self.noise(9, 350.0, site.warped);
        (COAST * (site.coast() - self.threshold + detail)) as f32
    }

    /// The regional part of the logarithm of uplift over erodibility at (x, y) in metres.
    pub fn uplift(&self, x: f64, y: f64) -> f32 {
        let site = self.site(x, y);
        let Site { plain, warped, turned: [once, twice, _], .. } = site;
        let swell = self.noise(10, 1000.0, plain) + 0.5 * self.noise(11, 430.0, once);
        let mut uplift = -2.25 + 1.3 * swell;
        // Plateaus: gentle within a steep rim.
        let form = self.noise(12, 2700.0, once) + 0.25 * self.noise(13, 600.0, plain);
        uplift += (-1.7 + 0.5 * swell - uplift) * smooth_step(0.12, 0.25, form);
        let off_rim = (form - 0.15) / 0.05;
        let rim = libm::exp(-(off_rim * off_rim)) * smooth_step(-0.25, 0.3, self.noise(23, 800.0, warped));
        uplift += (0.2 + 0.6 * swell - uplift).max(0.0) * rim;
        // Old mountains.
        let old = self.noise(14, 1200.0, warped) + 0.3 * self.noise(15, 400.0, twice);
        let old =
            smooth_step(0.0, 1.0, 1.0 - old.abs() / 0.2) * smooth_step(-0.05, 0.25, self.noise(16, 2400.0, plain));
        uplift += (-0.55 + 0.4 * swell - uplift).max(0.0) * old;
        // Ranges in belts across the continents and along some coasts.
        let belt = self.noise(17, 2600.0, warped) + 0.3 * self.noise(18, 850.0, once);
        let belt =
            smooth_step(0.0, 0.8, 1.0 - belt.abs() / 0.15) * smooth_step(-0.08, 0.2, self.noise(19, 2900.0, plain));
        let inland = (COAST * (site.coast() - self.threshold) - 190.0) / 120.0;
        let coastal = libm::exp(-(inland * inland)) * smooth_step(0.0, 0.22, self.noise(20, 3300.0, twice));
        let range = 0.4 + 0.5 * self.noise(21, 500.0, plain) + 0.35 * self.noise(22, 160.0, once);
        (uplift + (range - uplift).max(0.0) * belt.max(coastal)) as f32
    }
}

impl Site<'_> {
    /// The shape of the coast without its detail, about -0.9 to 0.9.
    fn coast(&self) -> f64 {
        let [once, twice, _] = self.turned;
        let geography = self.geography;
        geography.noise(5, 5600.0, self.warped)
            + 0.55 * geography.noise(6, 2800.0, once)
            + 0.28 * geography.noise(7, 1400.0, twice)
    }
}
