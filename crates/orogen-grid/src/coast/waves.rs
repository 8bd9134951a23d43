//! Waves by their fetch, and the winds that raise them.

use super::Coast;

/// Directions from which wind blows.
pub(super) const DIRECTIONS: usize = 32;

const GRAVITY: f64 = 9.81;
/// Density of sea water, in kg/m^3.
const DENSITY: f64 = 1025.0;
/// Entries of the table over the root of the fetch.
const ENTRIES: usize = 1024;

/// A direction of the wind.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wind {
    /// Unit vector to where the wind comes from: east and south.
    pub(super) from: [f64; 2],
    /// Share of the time.
    pub(super) share: f64,
}

/// The winds of a coast, clockwise from north.
pub(super) fn winds(law: &Coast) -> Vec<Wind> {
    // None along rows, columns or diagonals, in which fetches would not be mixed across the wind.
    let angle = |k: usize| (k as f64 + 0.5) * 2.0 * std::f64::consts::PI / DIRECTIONS as f64;
    let main = law.wind_direction.to_radians();
    // A lobe that is half as high 33 degrees beside the main direction, with a sum of 1.
    let lobe = |k: usize| {
        let cos = libm::cos(angle(k) - main).max(0.0);
        cos * cos * (cos * cos)
    };
    let sum: f64 = (0..DIRECTIONS).map(lobe).sum();
    let wind = |k: usize| Wind {
        from: [libm::sin(angle(k)), -libm::cos(angle(k))],
        share: (1.0 - law.wind_share) / DIRECTIONS as f64 + law.wind_share * lobe(k) / sum,
    };
    (0..DIRECTIONS).map(wind).collect()
}

/// Height in metres and period in seconds of the waves that a wind of `speed` raises over a fetch in deep water
/// (Sverdrup, Munk and Bretschneider, in the Shore Protection Manual, CERC 1977).
pub(super) fn wave(speed: f64, fetch: f64) -> [f64; 2] {
    if speed <= 0.0 || fetch <= 0.0 {
        return [0.0; 2];
    }
    let reach = GRAVITY * fetch / (speed * speed);
    let height = 0.283 * libm::tanh(0.0125 * libm::pow(reach, 0.42)) * speed * speed / GRAVITY;
    let period = 7.54 * libm::tanh(0.077 * libm::pow(reach, 0.25)) * speed / GRAVITY;
    [height, period]
}

/// Quantities of waves as tables over the fetch.
pub(super) struct Waves {
    longest: f64,
    /// Power in W/m, and H^(12/5) T^(1/5), in which longshore transport grows.
    entries: Vec<[f32; 2]>,
}

impl Waves {
    pub(super) fn new(law: &Coast) -> Waves {
        let entry = |k: usize| {
            let share = k as f64 / (ENTRIES - 1) as f64;
            let [height, period] = wave(law.wind_speed, law.fetch * share * share);
            let power = DENSITY * GRAVITY * GRAVITY * height * height * period / (64.0 * std::f64::consts::PI);
            let drift = libm::pow(height, 2.4) * libm::pow(period, 0.2);
            [power as f32, drift as f32]
        };
        Waves { longest: law.fetch, entries: (0..ENTRIES).map(entry).collect() }
    }

    /// Power and drift of the waves of a fetch.
    pub(super) fn of(&self, fetch: f32) -> [f32; 2] {
        let share = (f64::from(fetch) / self.longest).clamp(0.0, 1.0).sqrt() * (ENTRIES - 1) as f64;
        let below = (share as usize).min(ENTRIES - 2);
        let part = (share - below as f64) as f32;
        let [low, high] = [self.entries[below], self.entries[below + 1]];
        [0, 1].map(|k| low[k] + part * (high[k] - low[k]))
    }

    /// Power of the waves that reach a straight coast, open to the sea towards the main wind.
    pub(super) fn open(&self, law: &Coast, winds: &[Wind]) -> f64 {
        let main = law.wind_direction.to_radians();
        let sea = [libm::sin(main), -libm::cos(main)];
        let faced = |wind: &&Wind| wind.from[0] * sea[0] + wind.from[1] * sea[1] > 0.0;
        let share: f64 = winds.iter().filter(faced).map(|wind| wind.share).sum();
        share * f64::from(self.entries[ENTRIES - 1][0])
    }
}
