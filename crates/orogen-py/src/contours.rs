//! Contour lines of arrays of heights.

use numpy::{PyArray1, PyArray2, PyArrayMethods};
use orogen::grid::contour;
use pyo3::prelude::*;

use crate::array::{Heights, grid};
use crate::run::run;

/// Contour lines: the height of each, whether it is closed, and its points in metres east and south of the first
/// sample, of shape (n, 2).
type Lines<'py> = Vec<(f64, bool, Bound<'py, PyArray2<f64>>)>;

/// The contour lines at these levels, or at the multiples of `interval`.
#[pyfunction]
#[pyo3(signature = (heights, cell, levels, interval))]
pub fn contours<'py>(
    py: Python<'py>,
    heights: Heights<'py>,
    cell: f64,
    levels: Option<Vec<f64>>,
    interval: Option<f64>,
) -> PyResult<Lines<'py>> {
    let heights = grid(&heights, cell)?;
    let lines = run(py, None, |_| {
        let levels = match (levels, interval) {
            (Some(levels), _) => contour::levels::given(&levels)?,
            (None, interval) => {
                let finite = heights.data().iter().copied().filter(|height| height.is_finite());
                let [low, high] = finite.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], height| {
                    [low.min(f64::from(height)), high.max(f64::from(height))]
                });
                if low > high {
                    return Ok(Vec::new());
                }
                contour::levels_every(interval.unwrap_or_else(|| contour::round_interval(high - low, 10)), low, high)?
            }
        };
        contour::contours(&heights, &levels)
    })?;
    let array = |points: &[[f64; 2]]| PyArray1::from_slice(py, points.as_flattened()).reshape([points.len(), 2]);
    lines.iter().map(|line| Ok((line.elevation, line.closed, array(&line.points)?))).collect()
}
