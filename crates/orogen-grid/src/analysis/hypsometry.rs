//! Hypsometry: the distribution of area over heights.

use crate::grid::Grid;

/// The hypsometric curve (Strahler 1952): the share of the area, 0 to 1, at or above each of `steps` + 1 evenly spaced
/// heights from the lowest to the highest. `None` if no sample is finite or `steps` is 0.
#[must_use]
pub fn hypsometric_curve(grid: &Grid, steps: usize) -> Option<Vec<f64>> {
    let (low, high) = range(grid)?;
    if steps == 0 {
        return None;
    }
    let mut counts = vec![0u64; steps + 1];
    let scale = steps as f64 / (high - low);
    let mut total = 0u64;
    for h in grid.data().iter().filter(|h| h.is_finite()) {
        // The highest step at or below this height.
        let step = if high > low { ((f64::from(*h) - low) * scale) as usize } else { steps };
        counts[step.min(steps)] += 1;
        total += 1;
    }
    let mut above = 0;
    let mut curve: Vec<f64> = counts
        .iter()
        .rev()
        .map(|count| {
            above += count;
            above as f64 / total as f64
        })
        .collect();
    curve.reverse();
    Some(curve)
}

/// The hypsometric integral, 0 to 1: (mean - lowest) / (highest - lowest). `None` if there is no relief.
#[must_use]
pub fn hypsometric_integral(grid: &Grid) -> Option<f64> {
    let (low, high) = range(grid)?;
    let (mut sum, mut count) = (0.0, 0u64);
    for h in grid.data().iter().filter(|h| h.is_finite()) {
        sum += f64::from(*h) - low;
        count += 1;
    }
    (high > low).then(|| sum / count as f64 / (high - low))
}

fn range(grid: &Grid) -> Option<(f64, f64)> {
    let finite = grid.data().iter().filter(|h| h.is_finite());
    let (low, high) = finite.fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), h| (low.min(*h), high.max(*h)));
    (low <= high).then_some((f64::from(low), f64::from(high)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Window;

    #[test]
    fn a_ramp_is_a_straight_line() {
        let data = (0..=1000).map(|k| k as f32 * 0.5).collect();
        let ramp = Grid::from_data(Window::new(1001, 1, 1.0), data).unwrap();
        let curve = hypsometric_curve(&ramp, 10).unwrap();
        for (k, share) in curve.iter().enumerate() {
            assert!((share - (1.0 - k as f64 / 10.0)).abs() < 2e-3, "{curve:?}");
        }
        assert!((hypsometric_integral(&ramp).unwrap() - 0.5).abs() < 1e-9);
    }

    #[test]
    fn missing_samples_and_level_ground() {
        let grid = Grid::from_data(Window::new(4, 1, 1.0), vec![f32::NAN, 1.0, 3.0, 3.0]).unwrap();
        assert_eq!(hypsometric_curve(&grid, 2).unwrap(), [1.0, 2.0 / 3.0, 2.0 / 3.0]);
        let level = Grid::filled(Window::new(3, 3, 1.0), 2.0);
        assert_eq!((hypsometric_curve(&level, 2).unwrap(), hypsometric_integral(&level)), (vec![1.0; 3], None));
        assert_eq!(hypsometric_curve(&Grid::filled(Window::new(2, 2, 1.0), f32::NAN), 5), None);
        assert_eq!(hypsometric_curve(&grid, 0), None);
    }
}
