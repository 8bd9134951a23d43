//! The rows of a report.

use serde_json::{Value, json};

/// The target of a case.
#[derive(Clone, Copy)]
pub struct Target {
    /// The peer.
    pub peer: &'static str,
    /// Required ratio to the peer's rate.
    pub ratio: f64,
    /// A rate that suffices on its own, if there is one.
    pub or_rate: Option<f64>,
}

/// A case compared with a peer, or without a peer. Rates are in millions of samples per second.
pub struct Row {
    /// The case.
    pub case: String,
    /// Our rate; `None` if we do not offer it.
    pub ours: Option<f64>,
    /// The peer and its rate.
    pub peer: Option<(&'static str, f64)>,
    /// The target, if it refers to this peer.
    pub target: Option<Target>,
}

impl Row {
    /// The row as JSON. A target is not met if there is no rate of ours.
    pub fn json(&self) -> Value {
        let ratio = self.ours.zip(self.peer).map(|(ours, (_, theirs))| ours / theirs);
        let met = self.target.map(|target| {
            let enough = |limit: Option<f64>| self.ours.zip(limit).is_some_and(|(ours, limit)| ours >= limit);
            ratio.is_some_and(|r| r >= target.ratio) || enough(target.or_rate)
        });
        json!({
            "case": self.case,
            "ours": self.ours.map(rounded),
            "unit": "Msamples/s",
            "peer": self.peer.map(|(name, _)| name).or(self.target.map(|t| t.peer)),
            "peer_value": self.peer.map(|(_, rate)| rounded(rate)),
            "ratio": ratio.map(rounded),
            "target": self.target.map(|t| t.ratio),
            "met": met,
        })
    }
}

/// Two decimals; more would be noise.
fn rounded(x: f64) -> f64 {
    (x * 100.0).round() / 100.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn targets() {
        let target = |ratio, or_rate| Some(Target { peer: "p", ratio, or_rate });
        for (ours, peer, target, ratio, met) in [
            (Some(84.0), Some(("p", 2.0)), target(42.0, None), json!(42.0), json!(true)),
            (Some(83.0), Some(("p", 2.0)), target(42.0, None), json!(41.5), json!(false)),
            (Some(83.0), Some(("p", 2.0)), None, json!(41.5), json!(null)),
            (Some(50.0), Some(("p", 100.0)), target(0.8, Some(40.0)), json!(0.5), json!(true)),
            (None, None, target(3.0, None), json!(null), json!(false)),
        ] {
            let row = Row { case: "c".to_owned(), ours, peer, target }.json();
            assert_eq!((&row["ratio"], &row["met"], &row["peer"]), (&ratio, &met, &json!("p")), "{row}");
        }
    }
}
