//! Figures with targets.

use serde_json::{Value, json};

/// The target of a figure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// Maximum of the figure.
    AtMost(f64),
    /// Maximum ratio of the figure to the other figure.
    RatioAtMost(f64),
    /// Minimum ratio of the other figure to the figure (speedup).
    FasterBy(f64),
    /// No target.
    None,
}

/// A figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// The case.
    pub case: String,
    /// Our figure.
    pub ours: f64,
    /// The unit.
    pub unit: &'static str,
    /// The comparison, with its figure.
    pub other: Option<(&'static str, f64)>,
    /// The target.
    pub target: Target,
}

impl Figure {
    /// A row of the report.
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

/// Three decimals; more would be noise.
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
