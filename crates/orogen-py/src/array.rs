//! Arrays to grids and back. The Python part makes arrays contiguous, of the right type and with NaN for missing
//! samples.

use numpy::{Element, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2, PyUntypedArrayMethods};
use orogen::{Grid, Window};
use pyo3::prelude::*;

use crate::failure::{internal, refused};

/// An array of heights.
pub type Heights<'py> = PyReadonlyArray2<'py, f32>;

/// The window and the samples of an array, by rows from the north. Cells are `cell` metres apart.
pub fn samples<'a>(heights: &'a Heights<'_>, cell: f64) -> PyResult<(Window, &'a [f32])> {
    let py = heights.py();
    let &[height, width] = heights.shape() else { return Err(internal(py, "an array without two dimensions")) };
    if !(cell.is_finite() && cell > 0.0) {
        return Err(refused(py, &format!("`cell` must be a number of metres greater than 0, not {cell}")));
    }
    if width == 0 || height == 0 {
        return Err(refused(py, &format!("the array has no samples: its shape is ({height}, {width})")));
    }
    if u32::try_from(width * height).is_err() {
        return Err(refused(py, &format!("an array can have at most 2^32 samples, not {height} x {width}")));
    }
    let data = heights.as_slice().map_err(|_| internal(py, "an array that is not contiguous"))?;
    Ok((Window::new(width, height, cell), data))
}

/// The samples of an array as a grid; row 0 is the northernmost. Cells are `cell` metres apart.
pub fn grid(heights: &Heights<'_>, cell: f64) -> PyResult<Grid> {
    let (window, data) = samples(heights, cell)?;
    let grid = Grid::from_data(window, data.to_vec());
    grid.ok_or_else(|| internal(heights.py(), "an array with another number of samples than its shape"))
}

/// The samples of a grid as an array, without a copy.
pub fn array<T: Element + Copy>(py: Python<'_>, grid: Grid<T>) -> PyResult<Bound<'_, PyArray2<T>>> {
    let shape = [grid.height(), grid.width()];
    PyArray1::from_vec(py, grid.into_data()).reshape(shape)
}
