//! Colours for heights: ramps between stops, and the atlas tint for land and sea.
//!
//! Colours between stops are mixed in Oklab (B. Ottosson, 2020), where equal steps look equal and a mix of green and brown does
//! not turn grey. What comes out is linear light, so that shading may multiply it; [`Encoder`] makes the bytes.

use crate::format::levels::Levels;
use crate::grid::Grid;

/// A colour as linear light: red, green, blue, 0 to 1.
pub type Light = [f32; 3];

/// How finely a ramp is tabulated: steps are far below what eight bits can show.
const STEPS: usize = 1024;

/// Colours along 0 to 1.
#[derive(Debug, Clone)]
pub struct Ramp {
    table: Vec<Light>,
}

impl Ramp {
    /// A ramp through `stops`: positions in ascending order, and their colours as sRGB bytes. Before the first stop and
    /// behind the last it is level; without any stop it is black.
    pub fn new(stops: &[(f32, [u8; 3])]) -> Ramp {
        Ramp::bent(stops, |at| at)
    }

    /// As [`Ramp::new`], with the colour of `bend(at)` at `at`.
    fn bent(stops: &[(f32, [u8; 3])], bend: impl Fn(f32) -> f32) -> Ramp {
        let labs: Vec<(f32, [f32; 3])> =
            stops.iter().map(|&(at, [r, g, b])| (at, oklab([decode(r), decode(g), decode(b)]))).collect();
        let table = (0..=STEPS).map(|step| linear(between(&labs, bend(step as f32 / STEPS as f32)))).collect();
        Ramp { table }
    }

    /// The colour at `at`, clamped to 0 to 1; NaN is taken as 0.
    pub fn at(&self, at: f32) -> Light {
        let at = if at > 0.0 { at.min(1.0) * STEPS as f32 } else { 0.0 };
        let index = (at as usize).min(STEPS - 1);
        mix(self.table[index], self.table[index + 1], at - index as f32)
    }
}

/// The mixed colour of the two stops around `at`.
fn between(stops: &[(f32, [f32; 3])], at: f32) -> [f32; 3] {
    let after = stops.partition_point(|stop| stop.0 <= at);
    match (after.checked_sub(1).map(|before| stops[before]), stops.get(after)) {
        (Some((start, from)), Some(&(end, to))) => mix(from, to, (at - start) / (end - start)),
        (Some((_, color)), None) | (None, Some(&(_, color))) => color,
        (None, None) => [0.0; 3],
    }
}

fn mix(from: [f32; 3], to: [f32; 3], share: f32) -> [f32; 3] {
    std::array::from_fn(|i| from[i] + (to[i] - from[i]) * share)
}

/// The atlas tint: green lowlands through straw and ochre to brown, grey and white heights; a sea that darkens with depth. Land
/// and sea meet exactly at sea level.
///
/// A printed atlas gives every height one colour, which paints 300 m hills all green; stretching all colours over whatever
/// relief there is paints them with snow. This does a bit of both: the more relief the land has, the further up the atlas its
/// summits reach (300 m to ochre, 4000 m to white), and likewise the deeper the sea. And as real land is mostly low, land of
/// which much stands high is bent towards the greens, so that its summits still stand out.
#[derive(Debug, Clone)]
pub struct Tint {
    land: Ramp,
    sea: Ramp,
    sea_level: f32,
    /// Where the land's colours begin, and the shares of the ramps that a metre is worth.
    base: f32,
    land_scale: f32,
    sea_scale: f32,
}

/// Land from the lowest up. Lightness falls to the browns and rises again to the snow, as on printed relief maps.
const LAND: [(f32, [u8; 3]); 10] = [
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

/// The sea from the shore down.
const SEA: [(f32, [u8; 3]); 6] = [
    (0.00, [190, 222, 229]),
    (0.12, [160, 206, 223]),
    (0.35, [113, 175, 210]),
    (0.60, [74, 138, 188]),
    (0.80, [49, 103, 158]),
    (1.00, [31, 72, 122]),
];

/// Where on its relief half of the land should lie below, and how far colours are bent at most to get there.
const MIDDLE: f32 = 0.40;
const MOST_BENT: f32 = 1.4;

/// How many samples are looked at to find the middle of the land.
const PROBES: usize = 1 << 16;

impl Tint {
    /// The tint for a world between `low` and `high` with the sea at `sea_level`, all in metres.
    pub fn hypsometric(low: f32, high: f32, sea_level: f32) -> Tint {
        Tint::bent(low, high, sea_level, 1.0)
    }

    /// The tint that suits the heights of a grid.
    pub fn fit(grid: &Grid, sea_level: f32) -> Tint {
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
        Tint::bent(low, high, sea_level, (libm::logf(MIDDLE) / libm::logf(share)).clamp(1.0, MOST_BENT))
    }

    /// The land's colours by `share of the relief ^ power`.
    fn bent(low: f32, high: f32, sea_level: f32, power: f32) -> Tint {
        // Land that does not touch the sea begins with green at its own foot: plateaus have lowlands too.
        let base = if low.is_finite() { low.max(sea_level) } else { sea_level };
        let relief = if high > base { high - base } else { 0.0 };
        let depth = if low < sea_level { sea_level - low } else { 0.0 };
        let land_top = grows(relief, 100.0, 0.50, 3500.0, 1.0);
        let sea_top = grows(depth, 20.0, 0.30, 3000.0, 1.0);
        Tint {
            land: Ramp::bent(&LAND, |at| land_top * libm::powf(at, power)),
            sea: Ramp::bent(&SEA, |at| sea_top * at),
            sea_level,
            base,
            land_scale: inverse(relief),
            sea_scale: inverse(depth),
        }
    }

    /// Whether a height is under water.
    pub fn is_sea(&self, height: f32) -> bool {
        height <= self.sea_level
    }

    /// The colour of a height; of NaN, the lowest land's.
    pub fn at(&self, height: f32) -> Light {
        if self.is_sea(height) {
            // Shelves are wide and shallow: the square root shows them.
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

/// From `a` at x0 to `b` at x1, even steps for even ratios of x, level beyond.
fn grows(x: f32, x0: f32, a: f32, x1: f32, b: f32) -> f32 {
    let share = libm::logf(x.max(x0) / x0) / libm::logf(x1 / x0);
    a + (b - a) * share.min(1.0)
}

/// Turns linear light into sRGB bytes by table.
#[derive(Debug, Clone)]
pub struct Encoder {
    table: Vec<u8>,
}

/// Fine enough that even the darkest bytes are all reached.
const LEVELS: usize = 1 << 13;

impl Default for Encoder {
    fn default() -> Encoder {
        Encoder::new()
    }
}

impl Encoder {
    /// Prepares the table.
    pub fn new() -> Encoder {
        Encoder { table: (0..=LEVELS).map(|level| encode(level as f32 / LEVELS as f32)).collect() }
    }

    /// The sRGB bytes of a colour, clamped to what they can hold.
    pub fn bytes(&self, color: Light) -> [u8; 3] {
        color.map(|c| self.table[(c.clamp(0.0, 1.0) * LEVELS as f32 + 0.5) as usize])
    }
}

/// An sRGB byte as linear light (IEC 61966-2-1).
fn decode(byte: u8) -> f32 {
    let c = f32::from(byte) / 255.0;
    if c <= 0.04045 { c / 12.92 } else { libm::powf((c + 0.055) / 1.055, 2.4) }
}

/// Linear light as the nearest sRGB byte.
fn encode(light: f32) -> u8 {
    let c = if light <= 0.003_130_8 { light * 12.92 } else { 1.055 * libm::powf(light, 1.0 / 2.4) - 0.055 };
    (c.clamp(0.0, 1.0) * 255.0 + 0.5) as u8
}

/// Linear light in Oklab: lightness, green to red, blue to yellow.
fn oklab([r, g, b]: Light) -> [f32; 3] {
    let l = libm::cbrtf(0.412_221_46 * r + 0.536_332_55 * g + 0.051_445_995 * b);
    let m = libm::cbrtf(0.211_903_5 * r + 0.680_699_5 * g + 0.107_396_96 * b);
    let s = libm::cbrtf(0.088_302_46 * r + 0.281_718_85 * g + 0.629_978_7 * b);
    [
        0.210_454_26 * l + 0.793_617_8 * m - 0.004_072_047 * s,
        1.977_998_5 * l - 2.428_592_2 * m + 0.450_593_7 * s,
        0.025_904_037 * l + 0.782_771_77 * m - 0.808_675_77 * s,
    ]
}

/// Oklab as linear light.
fn linear([lightness, a, b]: [f32; 3]) -> Light {
    let l = lightness + 0.396_337_78 * a + 0.215_803_76 * b;
    let m = lightness - 0.105_561_346 * a - 0.063_854_17 * b;
    let s = lightness - 0.089_484_18 * a - 1.291_485_5 * b;
    let (l, m, s) = (l * l * l, m * m * m, s * s * s);
    [
        4.076_741_7 * l - 3.307_711_6 * m + 0.230_969_94 * s,
        -1.268_438 * l + 2.609_757_4 * m - 0.341_319_38 * s,
        -0.004_196_086_3 * l - 0.703_418_6 * m + 1.707_614_7 * s,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Window;

    #[test]
    fn every_byte_comes_back_through_light_and_oklab() {
        let encoder = Encoder::new();
        for byte in 0..=255u8 {
            assert_eq!(encode(decode(byte)), byte);
            assert_eq!(encoder.bytes([decode(byte); 3]), [byte; 3]);
            let color = [decode(byte), decode(255 - byte), decode(byte / 2)];
            let back = linear(oklab(color));
            assert!(color.iter().zip(back).all(|(c, b)| (c - b).abs() < 1e-5), "{byte}");
        }
    }

    #[test]
    fn a_ramp_passes_through_its_stops_and_is_level_outside() {
        let ramp = Ramp::new(&[(0.25, [10, 200, 30]), (0.5, [255, 0, 0]), (0.75, [0, 0, 255])]);
        let encoder = Encoder::new();
        for (at, expect) in [
            (-1.0, [10, 200, 30]),
            (f32::NAN, [10, 200, 30]),
            (0.25, [10, 200, 30]),
            (0.5, [255, 0, 0]),
            (0.75, [0, 0, 255]),
            (1.0, [0, 0, 255]),
            (f32::INFINITY, [0, 0, 255]),
        ] {
            assert_eq!(encoder.bytes(ramp.at(at)), expect, "{at}");
        }
        assert_eq!(encoder.bytes(Ramp::new(&[]).at(0.5)), [0, 0, 0]);
    }

    fn is_blue([_, g, b]: Light) -> bool {
        b > g
    }

    #[test]
    fn the_cut_is_exactly_at_sea_level() {
        for sea_level in [0.0f32, 12.5, -400.0, 2000.0] {
            let tint = Tint::hypsometric(sea_level - 300.0, sea_level + 800.0, sea_level);
            assert!(is_blue(tint.at(sea_level)) && is_blue(tint.at(sea_level.next_down())));
            assert!(!is_blue(tint.at(sea_level.next_up())));
        }
    }

    #[test]
    fn more_relief_reaches_higher_on_the_atlas() {
        let encoder = Encoder::new();
        let summit = |relief: f32| encoder.bytes(Tint::hypsometric(0.0, relief, 0.0).at(relief));
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
        let plain = Tint::hypsometric(0.0, 1000.0, -1.0);
        let high = Tint::fit(&grid(|share| 1000.0 * share.sqrt()), -1.0);
        let low = Tint::fit(&grid(|share| 1000.0 * share * share * share), -1.0);
        for height in [100.0, 300.0, 500.0] {
            let [red, bent, same] = [&plain, &high, &low].map(|tint| tint.at(height)[0]);
            assert!(bent < red && same == red, "{height}: {bent} {red} {same}");
        }
        assert_eq!([0.0, 1000.0].map(|h| high.at(h)), [0.0, 1000.0].map(|h| plain.at(h)));
        for height in [f32::NAN, 5.0, -5.0] {
            let tint = Tint::fit(&Grid::filled(window, height), 0.0);
            assert!([height, 0.0, 1e9].iter().all(|&h| tint.at(h).iter().all(|c| c.is_finite())));
        }
    }

    #[test]
    fn senseless_worlds_still_have_colours() {
        for (low, high) in [(5.0, 5.0), (f32::NAN, f32::NAN), (1.0, -1.0), (f32::MIN, f32::MAX)] {
            let tint = Tint::hypsometric(low, high, 0.0);
            for height in [f32::MIN, -1.0, 0.0, 1.0, f32::MAX, f32::NAN, f32::INFINITY] {
                assert!(tint.at(height).iter().all(|c| c.is_finite()), "{low} {high} {height}");
            }
        }
    }
}
