//! The hypsometric tint of printed atlases, fitted to the relief.

use super::color::{Light, Rgb, decode};
use super::palette::NO_DATA;
use super::ramp::Ramp;
use crate::format::levels::Levels;
use orogen_grid::grid::Grid;
use serde::{Deserialize, Serialize};

/// The atlas tint: green lowlands, then straw, ochre, brown, gray and white heights. The sea darkens with depth. Land
/// and sea meet exactly at sea level.
///
/// In a printed atlas every height has a fixed color, so hills of 300 m are all green. If all colors were stretched
/// over the relief, such hills would have snow. This tint is a compromise: the more relief the land has, the higher in
/// the ramp its summits are (300 m is ochre, 4000 m is white), and likewise for the depth of the sea. Most real land is
/// low. If much of the land is high, colors are shifted towards green, so that summits still stand out.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Atlas {
    land: Ramp,
    sea: Ramp,
    sea_level: f32,
    /// The height at which the land's colors start, and the shares of the ramps per metre.
    base: f32,
    land_scale: f32,
    sea_scale: f32,
}

/// Colors of the land, from the lowest height up. Lightness decreases towards brown and increases again towards snow,
/// as on printed maps.
pub const LAND: [(f32, Rgb); 10] = [
    (0.00, [101, 149, 103]),
    (0.10, [130, 170, 111]),
    (0.22, [168, 192, 126]),
    (0.34, [209, 209, 153]),
    (0.46, [217, 197, 140]),
    (0.58, [201, 166, 115]),
    (0.70, [173, 134, 98]),
    (0.82, [154, 129, 115]),
    (0.92, [196, 189, 184]),
    (1.00, [250, 251, 252]),
];

/// Colors of the sea, from the shore downward.
pub const SEA: [(f32, Rgb); 6] = [
    (0.00, [190, 222, 229]),
    (0.12, [160, 206, 223]),
    (0.35, [113, 175, 210]),
    (0.60, [74, 138, 188]),
    (0.80, [49, 103, 158]),
    (1.00, [31, 72, 122]),
];

/// The position in the ramp below which half of the land should lie, and the limit of the shift.
const MIDDLE: f32 = 0.40;
const MAX_BENT: f32 = 1.4;

/// Number of samples for the estimate of the median height of land.
const PROBES: usize = 1 << 16;

impl Atlas {
    /// The tint for a world with heights from `low` to `high` and the sea at `sea_level`, in metres.
    #[must_use]
    pub fn new(low: f32, high: f32, sea_level: f32) -> Atlas {
        Atlas::bent(low, high, sea_level, 1.0)
    }

    /// The tint fitted to the heights of a grid.
    pub fn fit(grid: &Grid, sea_level: f32) -> Atlas {
        let levels = Levels::of(grid);
        let (low, high) = (levels.low(), levels.high());
        let stride = grid.data().len() / PROBES + 1;
        let mut land: Vec<f32> =
            grid.data().iter().step_by(stride).copied().filter(|h| h.is_finite() && *h > sea_level).collect();
        let middle = land.len() / 2;
        let share = match land.is_empty() {
            true => MIDDLE,
            false => {
                let base = low.max(sea_level);
                let share = (*land.select_nth_unstable_by(middle, f32::total_cmp).1 - base) / (high - base);
                if share.is_finite() { share.clamp(0.01, 0.99) } else { MIDDLE }
            }
        };
        Atlas::bent(low, high, sea_level, (libm::logf(MIDDLE) / libm::logf(share)).clamp(1.0, MAX_BENT))
    }

    /// The tint with land colors at the position `share of the relief ^ power` in the ramp.
    fn bent(low: f32, high: f32, sea_level: f32, power: f32) -> Atlas {
        // Land above the sea starts with green at its lowest height, so that plateaus have lowlands, too.
        let base = if low.is_finite() { low.max(sea_level) } else { sea_level };
        let relief = if high > base { high - base } else { 0.0 };
        let depth = if low < sea_level { sea_level - low } else { 0.0 };
        let land_top = grows(relief, 100.0, 0.50, 3500.0, 1.0);
        let sea_top = grows(depth, 20.0, 0.30, 3000.0, 1.0);
        Atlas {
            land: Ramp::bent(&LAND, |at| land_top * libm::powf(at, power)),
            sea: Ramp::bent(&SEA, |at| sea_top * at),
            sea_level,
            base,
            land_scale: inverse(relief),
            sea_scale: inverse(depth),
        }
    }

    /// Whether a height is at or below sea level.
    #[must_use]
    pub fn is_sea(&self, height: f32) -> bool {
        height <= self.sea_level
    }

    /// The color of a height in metres; [`NO_DATA`] if it is not finite.
    pub fn at(&self, height: f32) -> Light {
        if !height.is_finite() {
            NO_DATA.map(decode)
        } else if self.is_sea(height) {
            // The square root resolves wide, shallow shelves.
            let depth = ((self.sea_level - height) * self.sea_scale).max(0.0).sqrt();
            self.sea.at(depth)
        } else {
            self.land.at((height - self.base) * self.land_scale)
        }
    }
}

fn inverse(range: f32) -> f32 {
    let inverse = 1.0 / range;
    if inverse.is_finite() { inverse } else { 0.0 }
}

/// Interpolates from `a` at x0 to `b` at x1, linearly in the logarithm of x. Constant outside.
fn grows(x: f32, x0: f32, a: f32, x1: f32, b: f32) -> f32 {
    let share = libm::logf(x.max(x0) / x0) / libm::logf(x1 / x0);
    a + (b - a) * share.min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::palette::color::Encoder;
    use orogen_grid::grid::Window;

    fn is_blue([_, g, b]: Light) -> bool {
        b > g
    }

    #[test]
    fn the_cut_is_exactly_at_sea_level() {
        for sea_level in [0.0f32, 12.5, -400.0, 2000.0] {
            let atlas = Atlas::new(sea_level - 300.0, sea_level + 800.0, sea_level);
            assert!(is_blue(atlas.at(sea_level)) && is_blue(atlas.at(sea_level.next_down())));
            assert!(!is_blue(atlas.at(sea_level.next_up())));
        }
    }

    #[test]
    fn more_relief_reaches_higher_on_the_atlas() {
        let encoder = Encoder::new();
        let summit = |relief: f32| encoder.bytes(Atlas::new(0.0, relief, 0.0).at(relief));
        let [r, g, b] = summit(300.0);
        assert!(r > 180 && r > g && g > b, "ochre, not snow: {r} {g} {b}");
        let [r, g, b] = summit(4000.0);
        assert!(r.min(g).min(b) > 240, "snow: {r} {g} {b}");
    }

    #[test]
    fn high_land_is_bent_towards_the_greens_and_low_land_is_not() {
        let window = Window::new(101, 1, 1.0);
        let grid = |height: fn(f32) -> f32| {
            Grid::from_data(window, (0..=100).map(|i| height(i as f32 / 100.0)).collect()).unwrap()
        };
        let plain = Atlas::new(0.0, 1000.0, -1.0);
        let high = Atlas::fit(&grid(|share| 1000.0 * share.sqrt()), -1.0);
        let low = Atlas::fit(&grid(|share| 1000.0 * share * share * share), -1.0);
        for height in [100.0, 300.0, 500.0] {
            let [red, bent, same] = [&plain, &high, &low].map(|atlas| atlas.at(height)[0]);
            assert!(bent < red && same == red, "{height}: {bent} {red} {same}");
        }
        assert_eq!([0.0, 1000.0].map(|h| high.at(h)), [0.0, 1000.0].map(|h| plain.at(h)));
        for height in [f32::NAN, 5.0, -5.0] {
            let atlas = Atlas::fit(&Grid::filled(window, height), 0.0);
            assert!([height, 0.0, 1e9].iter().all(|&h| atlas.at(h).iter().all(|c| c.is_finite())));
        }
    }

    #[test]
    fn senseless_worlds_still_have_colors() {
        for (low, high) in [(5.0, 5.0), (f32::NAN, f32::NAN), (1.0, -1.0), (f32::MIN, f32::MAX)] {
            let atlas = Atlas::new(low, high, 0.0);
            for height in [f32::MIN, -1.0, 0.0, 1.0, f32::MAX, f32::NAN, f32::INFINITY] {
                assert!(atlas.at(height).iter().all(|c| c.is_finite()), "{low} {high} {height}");
            }
        }
    }
}
