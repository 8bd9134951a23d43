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

/// Half the side of the square around a home whose corners are on land, in kilometres.
const HOME_SIDE: f64 = 90.0;

/// The threshold of the coast by share of land, in steps of 0.1 from 0 to 1: measured quantiles of the distance to
/// the shore in units of [`COAST`].
const THRESHOLDS: [f64; 11] = [0.76, 0.496, 0.335, 0.218, 0.115, 0.018, -0.078, -0.181, -0.301, -0.462, -0.7];

/// Kilometres of distance to the shore per unit of the shape of the coast.
const COAST: f64 = 1500.0;

/// Kilometres by which belts of ranges advance the shore.
const ARC: f64 = 300.0;

/// Width of the shelf that [`sea_bottom`](super::surface::sea_bottom) has, the median of the widths, and their range,
/// in kilometres.
const SHELF: f64 = 80.0;
const SHELF_WIDTH: f64 = 42.0;
const SHELF_WIDTHS: std::ops::Range<f64> = 25.0..400.0;

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
        let geography = Geography::without_home(land);
        Geography { home: geography.found_home(), ..geography }
    }

    /// The geography with the origin of its noises at the origin of the world.
    fn without_home(land: &Continents) -> Geography {
        let place = land.land * 10.0;
        let below = (place as usize).min(9);
        let share = place - below as f64;
        let threshold = THRESHOLDS[below] * (1.0 - share) + THRESHOLDS[below + 1] * share;
        Geography { seed: land.refinement.seed, threshold, scale: 0.001 / land.size, home: (0.0, 0.0) }
    }

    /// Returns a position in mountains near the sea, or else the position on land with the largest uplift, so that the
    /// land around the origin is interesting with every seed.
    fn found_home(&self) -> (f64, f64) {
        let mut best = (f32::NEG_INFINITY, (0.0, 0.0));
        for place in 0..PLACES {
            let draw = |shift: u32| f64::from(hash::unit(hash::node(self.seed, 0, place as i64, 0, 6) << shift));
            let at = (4e4 * draw(0), 4e4 * draw(24));
            let (x, y) = (at.0 / self.scale, at.1 / self.scale);
            // The coarsest level does not see a cape.
            let around = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
            let is_land = |(east, south): (f64, f64)| {
                self.shore(x + east * HOME_SIDE / self.scale, y + south * HOME_SIDE / self.scale) > 0.0
            };
            if !HOME_SHORE.contains(&self.shore(x, y)) || !around.into_iter().all(is_land) {
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

    /// The approximate distance to the shore in kilometres, positive on land, at (x, y) in metres. In the sea it is the
    /// distance at which a shelf of the usual width is as deep as the shelf here.
    pub fn shore(&self, x: f64, y: f64) -> f32 {
        let site = self.site(x, y);
        let [_, _, thrice] = site.turned;
        let detail = 0.2 * self.noise(8, 700.0, thrice) + 0.13 * self.noise(9, 350.0, site.warped);
        // Belts of mountains that leave the land become capes and arcs of islands.
        let distance = COAST * (site.coast() - self.threshold + detail) + ARC * site.belt();
        (if distance < 0.0 { site.over_shelf(distance) } else { distance }) as f32
    }

    /// The regional part of the logarithm of uplift over erodibility at (x, y) in metres.
    pub fn uplift(&self, x: f64, y: f64) -> f32 {
        let site = self.site(x, y);
        let Site { plain, warped, turned: [once, twice, _], .. } = site;
        let swell = self.noise(10, 1000.0, plain) + 0.5 * self.noise(11, 430.0, once);
        let mut uplift = -1.6 + 1.3 * swell + 1.9 * self.noise(26, 3400.0, twice);
        // Plateaus: gentle within a steep rim.
        let form = self.noise(12, 2700.0, once) + 0.25 * self.noise(13, 600.0, plain);
        uplift += (-1.7 + 0.5 * swell - uplift) * smooth_step(0.12, 0.25, form);
        let off_rim = (form - 0.15) / 0.05;
        let rim = libm::exp(-(off_rim * off_rim)) * smooth_step(-0.25, 0.3, self.noise(23, 800.0, warped));
        uplift += (0.8 + 0.6 * swell - uplift).max(0.0) * rim;
        // Old mountains.
        let old = self.noise(14, 1200.0, warped) + 0.3 * self.noise(15, 400.0, twice);
        let old =
            smooth_step(0.0, 1.0, 1.0 - old.abs() / 0.2) * smooth_step(-0.05, 0.25, self.noise(16, 2400.0, plain));
        uplift += (-0.55 + 0.4 * swell - uplift).max(0.0) * old;
        // Ranges in belts across the continents and along some coasts.
        let inland = (COAST * (site.coast() - self.threshold) - 190.0) / 120.0;
        let coastal = libm::exp(-(inland * inland)) * smooth_step(0.0, 0.22, site.coastal_ranges());
        let range = 0.55 + 0.5 * self.noise(21, 500.0, plain) + 0.35 * self.noise(22, 160.0, once);
        (uplift + (range - uplift).max(0.0) * site.belt().max(coastal)) as f32
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

    /// The share of a belt of ranges, 0 to 1.
    fn belt(&self) -> f64 {
        let geography = self.geography;
        let belt = geography.noise(17, 2600.0, self.warped) + 0.3 * geography.noise(18, 850.0, self.turned[0]);
        smooth_step(0.0, 0.8, 1.0 - belt.abs() / 0.15)
            * smooth_step(-0.08, 0.2, geography.noise(19, 2900.0, self.plain))
    }

    /// Above 0 where coasts have ranges.
    fn coastal_ranges(&self) -> f64 {
        self.geography.noise(20, 3300.0, self.turned[1])
    }

    /// The distance from the shore, negative and in kilometres, at which the sea with a shelf of [`SHELF`] km is as
    /// deep as at `distance` here. Shelves are narrow along coasts with ranges.
    fn over_shelf(&self, distance: f64) -> f64 {
        let geography = self.geography;
        let wide = 4.0 * geography.noise(24, 1900.0, self.plain) + 2.0 * geography.noise(25, 600.0, self.warped)
            - 3.2 * self.coastal_ranges();
        let width = (SHELF_WIDTH * libm::exp(wide)).clamp(SHELF_WIDTHS.start, SHELF_WIDTHS.end);
        let away = -distance;
        -(SHELF / width * away.min(width) + (away - width).max(0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::multiscale::surface::sea_bottom;

    /// Positions all over the worlds of 40 seeds.
    fn everywhere(land: f64) -> impl Iterator<Item = (Geography, f64, f64)> {
        (0..40_000u64).map(move |place| {
            let geography = Geography::without_home(&Continents::new(place % 40).with_land(land));
            let draw = |shift: u32| f64::from(hash::unit(hash::node(99, 0, place as i64, 0, 6) << shift));
            (geography, 2e8 * draw(0), 2e8 * draw(24))
        })
    }

    #[test]
    fn the_share_of_land_is_about_as_asked() {
        for land in [0.1, 0.37, 0.7] {
            let dry = everywhere(land).filter(|(geography, x, y)| geography.shore(*x, *y) >= 0.0).count();
            let share = dry as f64 / 40_000.0;
            assert!((share - land).abs() < 0.02, "{share} of {land}");
        }
    }

    /// Earth, from a relief of 20 arc-minutes (ETOPO, NOAA), ten windows of 8000 km: 0.33 of the sea at 80 to 150 km
    /// from the shore is shallower than 200 m, 0.17 at 150 to 300 km.
    #[test]
    fn shelves_are_narrow_and_wide_as_on_earth() {
        let (mut counts, mut shallow) = ([0u32; 2], [0u32; 2]);
        for (geography, x, y) in everywhere(0.37) {
            let site = geography.site(x, y);
            for (ring, away) in [115.0, 225.0].into_iter().enumerate() {
                counts[ring] += 1;
                shallow[ring] += u32::from(sea_bottom(-site.over_shelf(-away) as f32) > -200.0);
            }
        }
        let [near, far] = [0, 1].map(|ring| f64::from(shallow[ring]) / f64::from(counts[ring]));
        assert!((0.2..0.45).contains(&near) && (0.05..0.25).contains(&far), "{near} and {far}");
    }
}
