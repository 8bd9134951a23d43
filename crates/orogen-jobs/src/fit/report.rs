//! The comparison of a fitted recipe with its place and the default preset.

use super::features::FeatureVector;
use super::search::FitTarget;
use orogen_engine::recipe::presets;
use orogen_output::survey::measures::Measures;
use orogen_output::survey::real::FIGURES;
use serde_json::{Map, Value, json};

/// Three terrains side by side: the place, the fitted recipe's, the default preset's.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct FitReport {
    /// The name of the place.
    pub name: String,
    /// Distance between samples, in metres.
    pub cell: f64,
    /// Side of the compared windows, in samples.
    pub side: usize,
    /// Number of parameter sets that were tried.
    pub tried: usize,
    /// Number of windows of each terrain, and their median distance from the place's median in standard deviations of
    /// real terrain; NaN if no window could be measured.
    pub distances: [(usize, f64); 3],
    /// The median of each statistic of [`FIGURES`] over the windows of each terrain.
    pub figures: Vec<[Option<f64>; 3]>,
}

impl FitReport {
    /// The report of the measured windows of the three terrains.
    pub(super) fn of(name: &str, target: &FitTarget, lands: &[Vec<Measures>; 3], tried: usize) -> FitReport {
        let apart = |land: &[Measures]| {
            let distances = land.iter().map(|window| FeatureVector::of(window).distance(&target.middle)).collect();
            (land.len(), median(distances).unwrap_or(f64::NAN))
        };
        let own = (target.windows, median(target.own.clone()).unwrap_or(f64::NAN));
        let figures = FIGURES
            .iter()
            .map(|figure| {
                [0, 1, 2].map(|k| median(lands[k].iter().filter_map(|measures| figure.value(measures)).collect()))
            })
            .collect();
        FitReport {
            name: name.to_string(),
            cell: target.cell,
            side: target.side,
            tried,
            distances: [own, apart(&lands[1]), apart(&lands[2])],
            figures,
        }
    }

    /// The report as text for a terminal: a line about the search, and the table of the three terrains.
    #[must_use]
    pub fn words(&self) -> String {
        let FitReport { name, cell, side, tried, .. } = self;
        format!(
            "land like {name}, found among {tried} settings; medians over windows of {side} x {side} samples of \
             {cell:.1} m\n\n{}",
            self.table()
        )
    }

    /// The statistics of the three terrains in columns, then their distances and numbers of windows.
    fn table(&self) -> String {
        let [place, ours, defaults] = self.distances;
        let mut out = format!("{:<24}{:>12}{:>12}{:>12}\n", "", "the place", "the recipe", presets::DEFAULT);
        for (figure, values) in FIGURES.iter().zip(&self.figures) {
            let texts = values.map(|value| value.map_or("-".to_string(), |value| figure.text(value)));
            out.push_str(
                format!("{:<24}{:>12}{:>12}{:>12} {}", figure.name, texts[0], texts[1], texts[2], figure.unit)
                    .trim_end(),
            );
            out.push('\n');
        }
        out.push_str(&format!(
            "{:<24}{:>12.2}{:>12.2}{:>12.2}\n",
            "distance from the place", place.1, ours.1, defaults.1
        ));
        out.push_str(&format!("{:<24}{:>12}{:>12}{:>12}\n", "windows", place.0, ours.0, defaults.0));
        out
    }

    /// All numbers as an object of JSON, with a line end.
    #[must_use]
    pub fn to_json(&self) -> String {
        let land = |k: usize| {
            let values = FIGURES.iter().zip(&self.figures);
            let figures: Map<String, Value> =
                values.map(|(figure, values)| (figure.key.to_string(), json!(values[k]))).collect();
            json!({ "windows": self.distances[k].0, "distance": self.distances[k].1, "figures": figures })
        };
        let whole = json!({
            "cell": self.cell, "side": self.side, "tried": self.tried,
            "place": land(0), "recipe": land(1), "default_preset": land(2),
        });
        // A tree of numbers and strings can always be serialized.
        serde_json::to_string_pretty(&whole).unwrap_or_default() + "\n"
    }
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_unstable_by(f64::total_cmp);
    let half = values.len() / 2;
    match values.len() {
        0 => None,
        count if count.is_multiple_of(2) => Some((values[half - 1] + values[half]) / 2.0),
        _ => Some(values[half]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians_lie_in_the_middle() {
        assert_eq!(median(vec![]), None);
        assert_eq!((median(vec![3.0, 1.0, 2.0]), median(vec![4.0, 1.0, 3.0, 2.0])), (Some(2.0), Some(2.5)));
    }

    #[test]
    fn what_was_not_measured_is_a_dash_and_null() {
        let report = FitReport {
            name: "here".into(),
            cell: 30.0,
            side: 64,
            tried: 120,
            distances: [(4, 0.5), (2, 1.25), (0, f64::NAN)],
            figures: FIGURES.iter().map(|figure| [Some(figure.real[1]), None, None]).collect(),
        };
        let words = report.words();
        let (first, table) = words.split_once("\n\n").unwrap();
        assert_eq!(
            first,
            "land like here, found among 120 settings; medians over windows of 64 x 64 samples of 30.0 m"
        );
        assert_eq!(table.lines().count(), FIGURES.len() + 3, "{table}");
        assert!(table.contains("relief                          1022           -           - m\n"), "{table}");
        assert!(table.ends_with("windows                            4           2           0\n"), "{table}");
        let json: Value = serde_json::from_str(&report.to_json()).unwrap();
        assert_eq!(json["place"]["figures"]["relief"].as_f64(), Some(1022.0));
        assert!(json["recipe"]["figures"]["relief"].is_null() && json["default_preset"]["distance"].is_null());
    }
}
