//! Layers that are derived from arrays of heights.

use std::path::Path;
use std::sync::Arc;

use numpy::{PyArray2, PyArrayMethods, PyReadwriteArray2};
use orogen::export::derived::array::ArrayLayer;
use orogen::export::derived::list;
use orogen::io::dem::PreparedDem;
use orogen::io::dem::prepared::DEFAULT_MEMORY;
use orogen::io::format::dem::Dem;
use orogen::options::Options;
use orogen::{Grid, Progress, Recipe, Result, Session, Window};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::array::{Heights, array, samples};
use crate::failure::raised;
use crate::options::{of_keywords, of_work};
use crate::run::run;
use crate::world::{derived, request};

/// The samples of a layer: arrays of the shape of the heights, one for each channel. It has none where the heights are
/// missing; for their neighbors they are interpolated.
#[pyfunction]
#[pyo3(signature = (heights, layer, cell, options, progress))]
pub fn layer<'py>(
    py: Python<'py>,
    heights: Heights<'py>,
    layer: &str,
    cell: f64,
    options: &Bound<'py, PyDict>,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Vec<Bound<'py, PyArray2<f32>>>> {
    let options = of_keywords(&of_work("layer"), options)?;
    let (window, heights) = samples(&heights, cell)?;
    let direct =
        py.detach(|| ArrayLayer::new(layer, &window, heights, &options)).map_err(|error| raised(py, &error))?;
    if let Some(direct) = direct {
        let zeros = || PyArray2::zeros(py, [window.height, window.width], false);
        let made: Vec<Bound<'py, PyArray2<f32>>> = (0..direct.channels()).map(|_| zeros()).collect();
        let mut lent: Vec<PyReadwriteArray2<'py, f32>> = made.iter().map(|array| array.readwrite()).collect();
        let out = lent.iter_mut().filter_map(|array| array.as_slice_mut().ok()).collect();
        run(py, progress, |progress| direct.fill(out, progress))?;
        drop(lent);
        return Ok(made);
    }
    let made = run(py, progress, |progress| by_world(layer, &window, heights, &options, progress))?;
    made.into_iter().map(|grid| array(py, grid)).collect()
}

/// The layer of a world of these heights.
fn by_world(
    layer: &str,
    window: &Window,
    heights: &[f32],
    options: &Options,
    progress: &Progress,
) -> Result<Vec<Grid>> {
    let dem = Dem::new([window.width, window.height], heights.to_vec(), None).map_err(request)?;
    let place = PreparedDem::of(dem, Some(window.cell), DEFAULT_MEMORY).map_err(request)?;
    let mut recipe = Recipe::from_dem(Path::new("array"), &Arc::new(place));
    list::prepare(&mut recipe, layer, options)?;
    let world = Session::new(orogen::Options::default())?.open(recipe)?;
    let mut made = derived(&world, layer, window, progress)?;
    for grid in &mut made {
        let missing = grid.data_mut().iter_mut().zip(heights).filter(|(_, height)| height.is_nan());
        missing.for_each(|(sample, _)| *sample = f32::NAN);
    }
    Ok(made)
}
