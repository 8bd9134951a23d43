//! Hydrology on arrays of heights.

use numpy::PyArray2;
use orogen::grid::hydrology::above_drainage::above_drainage_with;
use orogen::grid::hydrology::accumulation::{Accumulation, accumulate_rain_with};
use orogen::grid::hydrology::direction::Convention;
use orogen::grid::hydrology::drainage::{Drainage, route_carving_with};
use orogen::grid::hydrology::fill::filled;
use orogen::grid::hydrology::lakes::lakes_with;
use orogen::grid::hydrology::least_cost::{self, Limits};
use orogen::grid::hydrology::outlets::Outlets;
use orogen::grid::hydrology::steepest::Descent;
use orogen::grid::hydrology::strahler::strahler_orders_with;
use orogen::grid::hydrology::watersheds::watersheds_with;
use orogen::{Grid, Progress, Result};
use pyo3::prelude::*;

use crate::array::{Heights, array, grid};
use crate::failure::refused;
use crate::run::run;

type Listener<'a, 'py> = Option<&'a Bound<'py, PyAny>>;
type Array<'py, T> = Bound<'py, PyArray2<T>>;

/// The drainage of heights.
struct Drained {
    outlets: Outlets,
    drainage: Drainage,
    accumulation: Accumulation,
}

/// Routes water over heights: depressions drain through their lowest pass. `random` is the seed of Rho8.
fn route(heights: &Grid, sea: Option<f32>, random: Option<u32>, progress: &Progress) -> Result<(Outlets, Drainage)> {
    let outlets = Outlets::new(heights, sea);
    let descent = random.map_or(Descent::Steepest, Descent::Scattered);
    let drainage = route_carving_with(heights, &outlets, descent, progress)?;
    Ok((outlets, drainage))
}

/// Routes water over heights and counts the cells that drain through each.
fn drained(heights: &Grid, sea: Option<f32>, rain: Option<&Grid>, progress: &Progress) -> Result<Drained> {
    let [routing, counting] = progress.parts([3.0, 1.0]);
    let (outlets, drainage) = route(heights, sea, None, &routing)?;
    routing.finish();
    let accumulation = accumulate_rain_with(&drainage.receivers, rain, &counting)?;
    counting.finish();
    Ok(Drained { outlets, drainage, accumulation })
}

/// The smallest number of cells with at least this area in square metres.
fn cells(py: Python<'_>, area: f64, cell: f64) -> PyResult<u32> {
    match (area / (cell * cell)).ceil() {
        count if count > 0.0 && count < f64::from(u32::MAX) => Ok(count as u32),
        _ => Err(refused(py, &format!("`area` must be a number of square metres greater than 0, not {area}"))),
    }
}

/// Heights with all depressions filled to their spill level.
#[pyfunction]
#[pyo3(signature = (heights, sea_level, progress))]
pub fn fill<'py>(
    py: Python<'py>,
    heights: Heights<'py>,
    sea_level: Option<f32>,
    progress: Listener<'_, 'py>,
) -> PyResult<Array<'py, f32>> {
    let heights = grid(&heights, 1.0)?;
    let made = run(py, progress, |progress| {
        let (_, drainage) = route(&heights, sea_level, None, progress)?;
        Ok(filled(&heights, &drainage.basins))
    })?;
    array(py, made)
}

/// Heights with channels cut through the rims of depressions along least-cost paths; what would need a deeper or
/// longer cut is filled.
#[pyfunction]
#[pyo3(signature = (heights, max_depth, max_length, sea_level, progress))]
pub fn breach<'py>(
    py: Python<'py>,
    heights: Heights<'py>,
    max_depth: f32,
    max_length: u32,
    sea_level: Option<f32>,
    progress: Listener<'_, 'py>,
) -> PyResult<Array<'py, f32>> {
    if max_depth.is_nan() || max_depth < 0.0 {
        return Err(refused(py, &format!("`max_depth` must be at least 0 m, not {max_depth}")));
    }
    let heights = grid(&heights, 1.0)?;
    let limits = Limits::new(max_depth, max_length);
    let made = run(py, progress, |progress| {
        least_cost::breach(&heights, &Outlets::new(&heights, sea_level), &limits, progress)
    })?;
    array(py, made)
}

/// The D8 flow direction of each cell, in the codes of a program; and the code for "no direction".
#[pyfunction]
#[pyo3(signature = (heights, convention, random, sea_level, progress))]
pub fn flow_direction<'py>(
    py: Python<'py>,
    heights: Heights<'py>,
    convention: &str,
    random: Option<u32>,
    sea_level: Option<f32>,
    progress: Listener<'_, 'py>,
) -> PyResult<Array<'py, u8>> {
    let known = [
        ("esri", Convention::ESRI),
        ("grass", Convention::GRASS),
        ("taudem", Convention::TAUDEM),
        ("whitebox", Convention::WHITEBOX),
        ("pcraster", Convention::PCRASTER),
    ];
    let Some((_, convention)) = known.into_iter().find(|(name, _)| *name == convention) else {
        let names = known.map(|(name, _)| name).join(", ");
        return Err(refused(py, &format!("`convention` must be one of {names}; not {convention:?}")));
    };
    let heights = grid(&heights, 1.0)?;
    let made = run(py, progress, |progress| {
        let (_, drainage) = route(&heights, sea_level, random, progress)?;
        Ok(drainage.receivers.coded(convention))
    })?;
    array(py, made)
}

/// The area in square metres that drains through each cell, the cell included; with `rain` in units of mean rain.
#[pyfunction]
#[pyo3(signature = (heights, cell, rain, sea_level, progress))]
pub fn accumulate<'py>(
    py: Python<'py>,
    heights: Heights<'py>,
    cell: f64,
    rain: Option<Heights<'py>>,
    sea_level: Option<f32>,
    progress: Listener<'_, 'py>,
) -> PyResult<Array<'py, f32>> {
    let heights = grid(&heights, cell)?;
    let rain = rain.map(|rain| grid(&rain, cell)).transpose()?;
    if rain.as_ref().is_some_and(|rain| rain.window() != heights.window()) {
        return Err(refused(py, "`rain` must have the shape of the heights"));
    }
    let made =
        run(py, progress, |progress| Ok(drained(&heights, sea_level, rain.as_ref(), progress)?.accumulation.areas()))?;
    array(py, made)
}

/// The watershed of each cell: numbers from 1, in the order of their outlets.
#[pyfunction]
#[pyo3(signature = (heights, sea_level, progress))]
pub fn watersheds<'py>(
    py: Python<'py>,
    heights: Heights<'py>,
    sea_level: Option<f32>,
    progress: Listener<'_, 'py>,
) -> PyResult<Array<'py, u32>> {
    let heights = grid(&heights, 1.0)?;
    let made = run(py, progress, |progress| {
        let [draining, labeling] = progress.parts([4.0, 1.0]);
        let Drained { outlets, drainage, accumulation } = drained(&heights, sea_level, None, &draining)?;
        watersheds_with(&drainage.receivers, &outlets, &accumulation, &labeling)
    })?;
    array(py, made)
}

/// The Strahler order of each stream cell; 0 elsewhere.
#[pyfunction]
#[pyo3(signature = (heights, cell, area, sea_level, progress))]
pub fn stream_order<'py>(
    py: Python<'py>,
    heights: Heights<'py>,
    cell: f64,
    area: f64,
    sea_level: Option<f32>,
    progress: Listener<'_, 'py>,
) -> PyResult<Array<'py, u8>> {
    let heights = grid(&heights, cell)?;
    let threshold = cells(py, area, cell)?;
    let made = run(py, progress, |progress| {
        let [draining, ordering] = progress.parts([4.0, 1.0]);
        let Drained { drainage, accumulation, .. } = drained(&heights, sea_level, None, &draining)?;
        strahler_orders_with(&drainage.receivers, &accumulation, threshold, &ordering)
    })?;
    array(py, made)
}

/// The height above the nearest stream along the flow path, and the length of that path.
#[pyfunction]
#[pyo3(signature = (heights, cell, area, sea_level, progress))]
pub fn above_drainage<'py>(
    py: Python<'py>,
    heights: Heights<'py>,
    cell: f64,
    area: f64,
    sea_level: Option<f32>,
    progress: Listener<'_, 'py>,
) -> PyResult<(Array<'py, f32>, Array<'py, f32>)> {
    let heights = grid(&heights, cell)?;
    let threshold = cells(py, area, cell)?;
    let made = run(py, progress, |progress| {
        let [draining, walking] = progress.parts([4.0, 1.0]);
        let Drained { drainage, accumulation, .. } = drained(&heights, sea_level, None, &draining)?;
        // Water flows over the filled surface.
        let surface = filled(&heights, &drainage.basins);
        above_drainage_with(surface, &drainage.receivers, &accumulation, threshold, &walking)
    })?;
    Ok((array(py, made.height)?, array(py, made.distance)?))
}

/// The lake of each cell, numbered from 1, 0 on land; and the water surface in lakes, the ground elsewhere.
#[pyfunction]
#[pyo3(signature = (heights, cell, area, sea_level, progress))]
pub fn lakes<'py>(
    py: Python<'py>,
    heights: Heights<'py>,
    cell: f64,
    area: f64,
    sea_level: Option<f32>,
    progress: Listener<'_, 'py>,
) -> PyResult<(Array<'py, u32>, Array<'py, f32>)> {
    let heights = grid(&heights, cell)?;
    let fewest = cells(py, area, cell)?;
    let made = run(py, progress, |progress| {
        let [routing, finding] = progress.parts([3.0, 2.0]);
        let (outlets, drainage) = route(&heights, sea_level, None, &routing)?;
        lakes_with(&heights, &outlets, &drainage, fewest, &finding)
    })?;
    Ok((array(py, made.labels)?, array(py, made.surface)?))
}
