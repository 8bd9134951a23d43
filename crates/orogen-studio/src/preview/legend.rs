//! The meaning of the colors of a picture.

use orogen::io::palette::Rgb;
use serde::{Deserialize, Serialize};

/// The meaning of the colors of a picture.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Legend {
    /// Colors of a range of values.
    Ramp {
        /// The values at its ends, in the unit of the layer.
        ends: [f32; 2],
        /// Evenly spaced colors from one end to the other.
        colors: Vec<Rgb>,
        /// Whether even distances correspond to even ratios.
        log: bool,
    },
    /// Named colors, the most frequent one first.
    Entries(Vec<Entry>),
}

/// A named color.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    /// The name.
    pub name: String,
    /// The color.
    pub color: Rgb,
    /// The share of the land, 0 to 1.
    pub share: f64,
}

/// Number of colors of a ramp.
pub const STEPS: usize = 64;

/// Maximum number of entries of a legend.
const MOST: usize = 12;

impl Legend {
    /// The legend of named classes, with the number of samples of each.
    #[must_use]
    pub fn of_counts(classes: &[(&str, Rgb)], counts: &[u64]) -> Legend {
        let total = counts.iter().sum::<u64>().max(1) as f64;
        let mut entries: Vec<Entry> = classes
            .iter()
            .zip(counts)
            .filter(|(_, count)| **count > 0)
            .map(|((name, color), count)| Entry {
                name: (*name).to_owned(),
                color: *color,
                share: *count as f64 / total,
            })
            .collect();
        entries.sort_by(|a, b| b.share.total_cmp(&a.share));
        entries.truncate(MOST);
        Legend::Entries(entries)
    }

    /// The position of a value on a ramp, 0 at its lower and 1 at its upper end; `None` outside, and for lists.
    #[must_use]
    pub fn place(&self, value: f32) -> Option<f32> {
        let Legend::Ramp { ends: [low, high], log, .. } = self else { return None };
        let place = match log {
            true => libm::logf(value / low) / libm::logf(high / low),
            false => (value - low) / (high - low),
        };
        (0.0..=1.0).contains(&place).then_some(place)
    }

    /// Round values within a ramp, about four or five.
    #[must_use]
    pub fn ticks(&self) -> Vec<f32> {
        let Legend::Ramp { ends: [low, high], log, .. } = *self else { return Vec::new() };
        if !(low.is_finite() && high.is_finite() && high > low) {
            return Vec::new();
        }
        if log {
            let decades = libm::log10f(low) as i32 - 1..=libm::log10f(high) as i32 + 1;
            let powers: Vec<f32> =
                decades.map(|n| libm::powf(10.0, n as f32)).filter(|value| (low..=high).contains(value)).collect();
            let step = powers.len().div_ceil(5).max(1);
            return powers.into_iter().step_by(step).collect();
        }
        let rough = f64::from(high - low) / 4.0;
        let power = libm::pow(10.0, libm::log10(rough).floor());
        let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|times| times * power).find(|step| *step >= rough);
        let step = step.unwrap_or(rough);
        let first = (f64::from(low) / step).ceil() as i64;
        let last = (f64::from(high) / step).floor() as i64;
        (first..=last).take(8).map(|k| (k as f64 * step) as f32).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_within_the_range() {
        let ramp = |ends, log| Legend::Ramp { ends, colors: Vec::new(), log };
        assert_eq!(ramp([-130.0, 2411.0], false).ticks(), [0.0, 1000.0, 2000.0]);
        assert_eq!(ramp([0.0, 1.0], false).ticks(), [0.0, 0.5, 1.0]);
        assert_eq!(ramp([90.0, 2e6], true).ticks(), [100.0, 1000.0, 10_000.0, 100_000.0, 1_000_000.0]);
        for ends in [[1.0, 1.0], [f32::NAN, 1.0], [f32::NEG_INFINITY, 0.0]] {
            assert!(ramp(ends, false).ticks().is_empty());
        }
    }

    #[test]
    fn values_have_places_on_ramps() {
        let ramp = |log| Legend::Ramp { ends: [1.0, 100.0], colors: Vec::new(), log };
        assert_eq!(ramp(true).place(10.0), Some(0.5));
        assert_eq!(ramp(false).place(1.0), Some(0.0));
        assert_eq!(ramp(false).place(200.0), None);
    }

    #[test]
    fn the_most_frequent_comes_first() {
        let classes = [("sea", [0, 0, 9]), ("sand", [9, 9, 0]), ("rock", [9; 3])];
        let Legend::Entries(entries) = Legend::of_counts(&classes, &[1, 0, 3]) else { panic!() };
        assert_eq!(entries.iter().map(|entry| entry.name.as_str()).collect::<Vec<_>>(), ["rock", "sea"]);
        assert_eq!(entries[0].share, 0.75);
    }
}
