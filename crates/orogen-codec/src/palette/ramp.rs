//! Color ramps over 0 to 1.

use super::color::{Light, Rgb, decode, linear, mix, oklab};
use serde::{Deserialize, Serialize};

/// Number of table entries, so that steps are far below the resolution of eight bits.
const STEPS: usize = 1024;

/// A color ramp over 0 to 1.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Ramp {
    table: Vec<Light>,
}

impl Ramp {
    /// A ramp through `stops`: positions in ascending order, with their colors in sRGB bytes. It is constant before the
    /// first stop and after the last one, and black without stops.
    #[must_use]
    pub fn new(stops: &[(f32, Rgb)]) -> Ramp {
        Ramp::bent(stops, |at| at)
    }

    /// Like [`Ramp::new`], but the color at `at` is the color of the stops at `bend(at)`.
    pub(super) fn bent(stops: &[(f32, Rgb)], bend: impl Fn(f32) -> f32) -> Ramp {
        let labs: Vec<(f32, [f32; 3])> =
            stops.iter().map(|&(at, [r, g, b])| (at, oklab([decode(r), decode(g), decode(b)]))).collect();
        let table = (0..=STEPS).map(|step| linear(between(&labs, bend(step as f32 / STEPS as f32)))).collect();
        Ramp { table }
    }

    /// The color at `at`, clamped to 0 to 1; NaN counts as 0.
    #[must_use]
    pub fn at(&self, at: f32) -> Light {
        let at = if at > 0.0 { at.min(1.0) * STEPS as f32 } else { 0.0 };
        let index = (at as usize).min(STEPS - 1);
        mix(self.table[index], self.table[index + 1], at - index as f32)
    }
}

/// The interpolated color at `at`, from the two stops around it.
fn between(stops: &[(f32, [f32; 3])], at: f32) -> [f32; 3] {
    let after = stops.partition_point(|stop| stop.0 <= at);
    match (after.checked_sub(1).map(|before| stops[before]), stops.get(after)) {
        (Some((start, from)), Some(&(end, to))) => mix(from, to, (at - start) / (end - start)),
        (Some((_, color)), None) | (None, Some(&(_, color))) => color,
        (None, None) => [0.0; 3],
    }
}

#[cfg(test)]
mod tests {
    use super::super::color::Encoder;
    use super::*;

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
}
