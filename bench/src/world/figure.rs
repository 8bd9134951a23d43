//! A figure that has to stay below, or reach, its target.

use serde_json::{Value, json};

/// What a figure is held against.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// The figure itself may be so much.
    AtMost(f64),
    /// The ratio of the figure to the other may be so much.
    RatioAtMost(f64),
    /// The ratio of the other to the figure has to be so much: how many times faster.
    FasterBy(f64),
    /// Nothing: it is told for its own sake.
    None,
}

/// One figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// What is measured.
    pub case: String,
    /// Ours.
    pub ours: f64,
    /// Its unit.
    pub unit: &'static str,
    /// What it is compared with, and the same figure for that.
    pub other: Option<(&'static str, f64)>,
    /// What it is held against.
    pub target: Target,
}

impl Figure {
    /// As a row of the report.
    pub fn json(&self) -> Value {
        let other = self.other.map(|(_, value)| value);
        let (ratio, target, met) = match self.target {
            Target::None => (None, None, None),
            Target::AtMost(most) => (None, Some(most), Some(self.ours <= most)),
            Target::RatioAtMost(most) => {
                let ratio = other.map(|other| self.ours / other);
                (ratio, Some(most), Some(ratio.is_some_and(|ratio| ratio <= most)))
            }
            Target::FasterBy(least) => {
                let ratio = other.map(|other| other / self.ours);
                (ratio, Some(least), Some(ratio.is_some_and(|ratio| ratio >= least)))
            }
        };
        json!({
            "case": self.case,
            "ours": rounded(self.ours),
            "unit": self.unit,
            "peer": self.other.map(|(name, _)| name),
            "peer_value": other.map(rounded),
            "ratio": ratio.map(rounded),
            "target": target,
            "met": met,
        })
    }
}

/// Three places: more would be noise.
fn rounded(x: f64) -> f64 {
    (x * 1000.0).round() / 1000.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn targets() {
        for (ours, other, target, ratio, met) in [
            (0.9, None, Target::AtMost(1.0), json!(null), json!(true)),
            (1.1, None, Target::AtMost(1.0), json!(null), json!(false)),
            (14.0, Some(("whole", 10.0)), Target::RatioAtMost(1.4), json!(1.4), json!(true)),
            (15.0, Some(("whole", 10.0)), Target::RatioAtMost(1.4), json!(1.5), json!(false)),
            (5.0, Some(("one thread", 9.5)), Target::FasterBy(1.9), json!(1.9), json!(true)),
            (5.0, Some(("one thread", 9.0)), Target::FasterBy(1.9), json!(1.8), json!(false)),
        ] {
            let row = Figure { case: "c".into(), ours, unit: "u", other, target }.json();
            assert_eq!((&row["ratio"], &row["met"]), (&ratio, &met), "{row}");
        }
    }
}
