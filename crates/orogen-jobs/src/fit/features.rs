//! Similarity of two terrains.

use orogen_grid::grid::{Grid, Window};
use orogen_output::survey::measures::Measures;
use orogen_output::survey::real::{FIGURES, Figure};

/// Statistics over orders of magnitude: their logarithms are compared, above these minimum values.
const LOGARITHMIC: [(&str, f64); 5] =
    [("relief", 1.0), ("slope_mean", 0.1), ("ruggedness", 0.01), ("curvature", 0.01), ("depressions", 0.05)];

/// Statistics that are not compared: they depend on the map's orientation, vary randomly between windows, or follow
/// from others.
const LEFT_OUT: [&str; 4] = ["grid_bias", "bifurcation", "length_ratio", "depression_depth"];

/// Distance between the 10 % and 90 % quantiles of a normal distribution, in standard deviations.
const TENTHS: f64 = 2.563;

/// The difference of a statistic that only one of two terrains has.
const MISSING: f64 = 3.0;

/// The compared statistics, each in units of its spread in real terrain.
#[derive(Debug, Clone, PartialEq)]
pub struct FeatureVector {
    values: Vec<Option<f64>>,
}

fn compared() -> impl Iterator<Item = &'static Figure> {
    FIGURES.iter().filter(|figure| !LEFT_OUT.contains(&figure.key))
}

impl FeatureVector {
    /// The features of measurements.
    #[must_use]
    pub fn of(measures: &Measures) -> FeatureVector {
        let value = |figure: &Figure| {
            let value = figure.value(measures)?;
            let least = LOGARITHMIC.iter().find(|(key, _)| *key == figure.key).map(|(_, least)| *least);
            let scaled = |value: f64| least.map_or(value, |least| libm::log(value.max(least)));
            Some(scaled(value) * TENTHS / (scaled(figure.real[2]) - scaled(figure.real[0])))
        };
        FeatureVector { values: compared().map(value).collect() }
    }

    /// The median of several, per statistic.
    #[must_use]
    pub fn middle(of: &[FeatureVector]) -> FeatureVector {
        let count = of.first().map_or(0, |first| first.values.len());
        let middle = |k: usize| {
            let mut values: Vec<f64> = of.iter().filter_map(|one| one.values.get(k).copied().flatten()).collect();
            values.sort_unstable_by(f64::total_cmp);
            let half = values.len() / 2;
            match (values.len(), values.len().is_multiple_of(2)) {
                (0, _) => None,
                (_, true) => Some((values[half - 1] + values[half]) / 2.0),
                (_, false) => Some(values[half]),
            }
        };
        FeatureVector { values: (0..count).map(middle).collect() }
    }

    /// The root mean square of the differences, in standard deviations of real terrain: 0 is equal, 1.4 is typical for
    /// two random pieces of real terrain.
    #[must_use]
    pub fn distance(&self, other: &FeatureVector) -> f64 {
        let differences = self.values.iter().zip(&other.values).map(|pair| match pair {
            (Some(a), Some(b)) => (a - b).clamp(-6.0, 6.0),
            (None, None) => 0.0,
            _ => MISSING,
        });
        (differences.map(|d| d * d).sum::<f64>() / self.values.len().max(1) as f64).sqrt()
    }
}

/// Windows of `side` x `side` samples spread over a grid without overlapping, at most `most`.
#[must_use]
pub fn windows(grid: &Window, side: usize, most: usize) -> Vec<Window> {
    let (columns, rows) = (grid.width / side, grid.height / side);
    let all: Vec<Window> = (0..columns * rows)
        .map(|k| Window {
            x: grid.x + (k % columns * side) as i64,
            y: grid.y + (k / columns * side) as i64,
            width: side,
            height: side,
            cell: grid.cell,
        })
        .collect();
    let every = all.len().div_ceil(most.max(1)).max(1);
    all.into_iter().step_by(every).collect()
}

/// The features of windows of a grid, without those that cannot be measured.
#[must_use]
pub fn of_windows(grid: &Grid, side: usize, most: usize) -> Vec<FeatureVector> {
    let crops = windows(grid.window(), side, most).into_iter().filter_map(|window| grid.crop(&window));
    crops.filter_map(|crop| Measures::of(&crop, None)).map(|measures| FeatureVector::of(&measures)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn like(values: &[Option<f64>]) -> FeatureVector {
        FeatureVector { values: values.to_vec() }
    }

    #[test]
    fn distances_are_roots_of_mean_squares() {
        let a = like(&[Some(1.0), Some(2.0), None, None]);
        let b = like(&[Some(4.0), Some(6.0), None, Some(9.0)]);
        assert_eq!(a.distance(&a), 0.0);
        assert!((a.distance(&b) - ((9.0 + 16.0 + 9.0) / 4.0f64).sqrt()).abs() < 1e-12);
        let middle = FeatureVector::middle(&[a.clone(), b.clone(), like(&[Some(2.0), None, None, None])]);
        assert_eq!(middle, like(&[Some(2.0), Some(4.0), None, Some(9.0)]));
    }

    #[test]
    fn windows_lie_side_by_side() {
        let found = windows(&Window::new(700, 530, 30.0), 256, 8);
        assert_eq!(found.len(), 4);
        assert!(found.iter().all(|window| Window::new(700, 530, 30.0).contains(window)));
        assert_eq!(windows(&Window::new(2560, 2560, 1.0), 256, 8).len(), 8);
        assert!(windows(&Window::new(100, 530, 30.0), 256, 8).is_empty());
    }
}
