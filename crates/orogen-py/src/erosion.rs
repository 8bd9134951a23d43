//! Erosion of arrays of heights.

use numpy::PyArray2;
use orogen::Grid;
use orogen::grid::erosion::droplets::Droplets;
use orogen::grid::erosion::pipe_rows::{BED, DEPTH};
use orogen::grid::erosion::pipes::{Pipes, Wet};
use orogen::grid::erosion::thermal::Thermal;
use orogen::grid::hydrology::erosion::Erosion;
use orogen::grid::hydrology::stream_power::{StreamPower, Substrate};
use pyo3::prelude::*;

use crate::array::{Heights, array, grid};
use crate::failure::refused;
use crate::run::run;

type Listener<'a, 'py> = Option<&'a Bound<'py, PyAny>>;
type Array<'py> = Bound<'py, PyArray2<f32>>;

/// Uplift and erosion by rivers.
#[pyfunction]
#[pyo3(signature = (heights, cell, *, years, steps, erodibility, area_exponent, slope_exponent, uplift, creep,
    erodibility_factor, uplift_factor, rain, sea_level, progress))]
#[expect(clippy::too_many_arguments, reason = "the Python part gives them by name")]
pub fn stream_power<'py>(
    py: Python<'py>,
    heights: Heights<'py>,
    cell: f64,
    years: f64,
    steps: u32,
    erodibility: f64,
    area_exponent: f64,
    slope_exponent: f64,
    uplift: f64,
    creep: f64,
    erodibility_factor: Option<Heights<'py>>,
    uplift_factor: Option<Heights<'py>>,
    rain: Option<Heights<'py>>,
    sea_level: Option<f32>,
    progress: Listener<'_, 'py>,
) -> PyResult<Array<'py>> {
    let mut heights = grid(&heights, cell)?;
    let factor = |name: &str, factor: Option<Heights<'py>>| -> PyResult<Option<Grid>> {
        let Some(factor) = factor else { return Ok(None) };
        let factor = grid(&factor, cell)?;
        match factor.window() == heights.window() {
            true => Ok(Some(factor)),
            false => Err(refused(py, &format!("`{name}` must have the shape of the heights"))),
        }
    };
    let erodibility_factor = factor("erodibility_factor", erodibility_factor)?;
    let uplift_factor = factor("uplift_factor", uplift_factor)?;
    let rain = factor("rain", rain)?;
    let law = StreamPower::default()
        .with_erodibility(erodibility)
        .with_area_exponent(area_exponent)
        .with_slope_exponent(slope_exponent)
        .with_uplift(uplift);
    let erosion = Erosion::new(law, years, steps).with_creep(creep);
    let made = run(py, progress, |progress| {
        let ground = Substrate::default()
            .with_erodibility_factor(erodibility_factor.as_ref())
            .with_uplift_factor(uplift_factor.as_ref())
            .with_rain(rain.as_ref());
        erosion.run(&mut heights, &ground, sea_level, progress)?;
        Ok(heights)
    })?;
    array(py, made)
}

/// Thermal weathering; beyond the border the heights go on as they are there.
#[pyfunction]
#[pyo3(signature = (heights, cell, *, talus, rate, passes, progress))]
pub fn thermal<'py>(
    py: Python<'py>,
    heights: Heights<'py>,
    cell: f64,
    talus: f64,
    rate: f64,
    passes: usize,
    progress: Listener<'_, 'py>,
) -> PyResult<Array<'py>> {
    let heights = grid(&heights, cell)?;
    let thermal = Thermal::new(talus).with_rate(rate);
    let made = run(py, progress, |progress| thermal.run(&heights.padded(passes), passes, progress))?;
    array(py, made)
}

/// Erosion with virtual pipes within walls: the ground, and the depth of the water.
#[pyfunction]
#[pyo3(signature = (heights, cell, *, iterations, rain, evaporation, capacity, erosion, deposition, friction, progress))]
#[expect(clippy::too_many_arguments, reason = "the Python part gives them by name")]
pub fn pipes<'py>(
    py: Python<'py>,
    heights: Heights<'py>,
    cell: f64,
    iterations: usize,
    rain: f64,
    evaporation: f64,
    capacity: f64,
    erosion: f64,
    deposition: f64,
    friction: f64,
    progress: Listener<'_, 'py>,
) -> PyResult<(Array<'py>, Array<'py>)> {
    let heights = grid(&heights, cell)?;
    let pipes = Pipes::default()
        .with_rain(rain)
        .with_evaporation(evaporation)
        .with_capacity(capacity)
        .with_erosion(erosion)
        .with_deposition(deposition)
        .with_friction(friction);
    let (bed, depth) = run(py, progress, |progress| {
        let wet = pipes.enclosed(Wet::new(&heights), iterations, progress)?;
        Ok((wet.plane(BED), wet.plane(DEPTH)))
    })?;
    Ok((array(py, bed)?, array(py, depth)?))
}

/// Erosion by droplets; beyond the border the heights go on as they are there.
#[pyfunction]
#[pyo3(signature = (heights, cell, *, density, batches, lifetime, radius, inertia, capacity, erosion, deposition,
    evaporation, gravity, seed, progress))]
#[expect(clippy::too_many_arguments, reason = "the Python part gives them by name")]
pub fn droplets<'py>(
    py: Python<'py>,
    heights: Heights<'py>,
    cell: f64,
    density: f64,
    batches: usize,
    lifetime: f64,
    radius: f64,
    inertia: f64,
    capacity: f64,
    erosion: f64,
    deposition: f64,
    evaporation: f64,
    gravity: f64,
    seed: u64,
    progress: Listener<'_, 'py>,
) -> PyResult<Array<'py>> {
    let heights = grid(&heights, cell)?;
    let droplets = Droplets::default()
        .with_density(density)
        .with_batches(batches)
        .with_lifetime(lifetime)
        .with_radius(radius)
        .with_inertia(inertia)
        .with_capacity(capacity)
        .with_erosion(erosion)
        .with_deposition(deposition)
        .with_evaporation(evaporation)
        .with_gravity(gravity)
        .with_seed(seed);
    let halo = droplets.halo(cell);
    let made = run(py, progress, |progress| droplets.run(&heights.padded(halo), progress))?;
    array(py, made)
}
