//! Noise at positions.

use numpy::{PyArray1, PyReadonlyArray1};
use orogen::jobs::noise::NoiseJob;
use orogen::noise::{Basis, Depth, LengthMismatch, Points};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::failure::{internal, raised, refused};
use crate::options::{of_keywords, of_work};
use crate::run::run;

/// Arrays of values: the noise, and with `gradient` its slopes along each axis.
type Values<'py> = Vec<Bound<'py, PyArray1<f32>>>;

/// The values of a noise at positions: `x` and `y` hold the columns and rows of a lattice, or a position each; `z` and
/// `w`, if given, one number for each sample, or one for all.
#[pyfunction]
#[pyo3(signature = (basis, x, y, z, w, is_lattice, gradient, options))]
#[expect(clippy::too_many_arguments, reason = "the Python part gives them by name")]
pub fn noise<'py>(
    py: Python<'py>,
    basis: &str,
    x: PyReadonlyArray1<'py, f64>,
    y: PyReadonlyArray1<'py, f64>,
    z: Option<PyReadonlyArray1<'py, f64>>,
    w: Option<PyReadonlyArray1<'py, f64>>,
    is_lattice: bool,
    gradient: bool,
    options: &Bound<'py, PyDict>,
) -> PyResult<Values<'py>> {
    let basis = Basis::from_name(basis).ok_or_else(|| internal(py, "an unknown noise"))?;
    let options = of_keywords(&of_work("noise"), options)?;
    let noise = NoiseJob::new(basis, &options).map_err(|error| raised(py, &error))?.noise;
    if gradient && !basis.has_gradient() {
        return Err(refused(py, "white noise is constant between its jumps and has no gradient"));
    }
    let (x, y) = (slice(&x)?, slice(&y)?);
    let points = if is_lattice { Points::Lattice { xs: x, ys: y } } else { Points::Scattered { x, y } };
    let depth = |z: &Option<PyReadonlyArray1<'py, f64>>| -> PyResult<Option<Vec<f64>>> {
        z.as_ref().map(|z| slice(z).map(<[f64]>::to_vec)).transpose()
    };
    let depths = [depth(&z)?, depth(&w)?];
    let axes = 2 + depths.iter().flatten().count();
    // Memory of this thread is used again by the next call, unlike that of a thread that ends.
    let mut value = vec![0.0; points.len()];
    let mut slopes = vec![vec![0.0; if gradient { points.len() } else { 0 }]; if gradient { axes } else { 0 }];
    let made = run(py, None, |_| {
        let depths: Vec<Depth> = depths.iter().flatten().map(|depth| depth_of(depth)).collect();
        Ok(fill(&noise, &points, &depths, &mut value, &mut slopes))
    })?;
    made.map_err(|mismatch: LengthMismatch| internal(py, &mismatch.to_string()))?;
    let arrays = [value].into_iter().chain(slopes);
    Ok(arrays.map(|values| PyArray1::from_vec(py, values)).collect())
}

/// One depth for all samples, or one for each.
fn depth_of(depth: &[f64]) -> Depth<'_> {
    match depth {
        [one] => Depth::Slice(*one),
        each => Depth::Each(each),
    }
}

/// Fills values and slopes, if there are slices for them.
fn fill(
    noise: &orogen::noise::Fractal,
    points: &Points,
    depths: &[Depth],
    value: &mut [f32],
    slopes: &mut [Vec<f32>],
) -> Result<(), LengthMismatch> {
    let mut slopes = slopes.iter_mut().map(Vec::as_mut_slice);
    match (depths, slopes.next()) {
        ([], None) => noise.fill(points, value),
        ([z], None) => noise.fill3(points, z, value),
        ([z, w, ..], None) => noise.fill4(points, &[*z, *w], value),
        (depths, Some(dx)) => {
            let [dy, dz, dw] = [(); 3].map(|()| slopes.next().unwrap_or_default());
            match depths {
                [] => noise.fill_with_gradient(points, value, dx, dy),
                [z] => noise.fill3_with_gradient(points, z, value, [dx, dy, dz]),
                [z, w, ..] => noise.fill4_with_gradient(points, &[*z, *w], value, [dx, dy, dz, dw]),
            }
        }
    }
}

fn slice<'a>(array: &'a PyReadonlyArray1<'_, f64>) -> PyResult<&'a [f64]> {
    array.as_slice().map_err(|_| internal(array.py(), "an array that is not contiguous"))
}
