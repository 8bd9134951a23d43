//! Statistics of a picture: range, histogram, hypsometric curve.

use orogen::Grid;
use orogen::grid::analysis::hypsometry;
use serde::{Deserialize, Serialize};

/// Number of bars of the histogram, and of steps of the curve.
pub const BARS: usize = 64;

/// Statistics of a layer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Statistics {
    /// The lowest and highest finite value; NaN if there is none.
    pub range: [f32; 2],
    /// The mean of finite values.
    pub mean: f64,
    /// Share of samples above the sea level, 0 to 1.
    pub land: f64,
    /// Share of the samples in each of `BARS` equal parts of the range.
    pub histogram: Vec<f32>,
    /// The share of the area at or above each of `BARS` + 1 heights of the range; empty if no sample is finite.
    pub curve: Vec<f64>,
}

impl Statistics {
    /// The statistics of a grid.
    #[must_use]
    pub fn of(grid: &Grid, sea_level: f64) -> Statistics {
        let [low, high] = range(grid.data().iter().copied());
        let mut counts = vec![0_u32; BARS];
        let (mut sum, mut finite, mut land) = (0.0, 0_u64, 0_u64);
        let scale = BARS as f32 / (high - low);
        for value in grid.data().iter().filter(|value| value.is_finite()) {
            // A constant grid has one bar.
            let bar = if high > low { ((value - low) * scale) as usize } else { 0 };
            counts[bar.min(BARS - 1)] += 1;
            sum += f64::from(*value);
            finite += 1;
            land += u64::from(f64::from(*value) > sea_level);
        }
        let share = |count: u64| if finite == 0 { f64::NAN } else { count as f64 / finite as f64 };
        Statistics {
            range: [low, high],
            mean: if finite == 0 { f64::NAN } else { sum / finite as f64 },
            land: share(land),
            histogram: counts.iter().map(|count| share(u64::from(*count)) as f32).collect(),
            curve: hypsometry::hypsometric_curve(grid, BARS).unwrap_or_default(),
        }
    }
}

/// The lowest and highest finite value; NaN if there is none.
#[must_use]
pub fn range(values: impl Iterator<Item = f32>) -> [f32; 2] {
    let finite = values.filter(|value| value.is_finite());
    let ends = finite.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)]);
    if ends[0] <= ends[1] { ends } else { [f32::NAN; 2] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen::Window;

    fn grid(values: &[f32]) -> Grid {
        Grid::from_data(Window::new(values.len(), 1, 1.0), values.to_vec()).unwrap()
    }

    #[test]
    fn figures() {
        let figures = Statistics::of(&grid(&[0.0, 1.0, 3.0, f32::NAN, 4.0]), 0.5);
        assert_eq!((figures.range, figures.mean, figures.land), ([0.0, 4.0], 2.0, 0.75));
        assert_eq!(figures.histogram.iter().sum::<f32>(), 1.0);
        assert_eq!((figures.histogram[0], figures.histogram[16], figures.histogram[BARS - 1]), (0.25, 0.25, 0.25));
        assert_eq!((figures.curve[0], figures.curve[BARS]), (1.0, 0.25));
    }

    #[test]
    fn constant_and_empty_grids() {
        let constant = Statistics::of(&grid(&[2.0, 2.0]), 0.0);
        assert_eq!((constant.range, constant.histogram[0]), ([2.0; 2], 1.0));
        let empty = Statistics::of(&grid(&[f32::NAN]), 0.0);
        assert!(empty.range[0].is_nan() && empty.curve.is_empty());
    }
}
