//! What the levelled ops that make drained land have in common.

use crate::op::{Context, Levels};
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::multiscale::given::Given;
use orogen_grid::multiscale::level::Level;
use orogen_grid::multiscale::refinement::Refinement;

/// Approximate time for a sample of a level below the coarsest, in nanoseconds.
pub const COST: f64 = 300.0;

/// The lattices of a refinement.
#[must_use]
pub fn levels(refinement: &Refinement) -> Levels {
    Levels { finest: refinement.cell, count: refinement.levels + 1 }
}

/// The planes of a level from those of the level above.
///
/// # Errors
/// If the planes are not those of a level, or the work was cancelled.
pub fn refine(
    refinement: &Refinement,
    level: usize,
    parent: &[Grid],
    given: &Given,
    window: &Window,
    context: &Context,
) -> Result<Vec<Grid>> {
    Ok(refinement.refine(&level_of(level - 1, parent)?, given, window, context.progress)?.into_planes())
}

/// The layers height, flow, lake, surface and receiver, on coarser levels at `share` of the sides of the cells.
///
/// # Errors
/// If the planes are not those of a level, or the work was cancelled.
pub fn layers_of(
    refinement: &Refinement,
    share: f32,
    level: usize,
    planes: &[Grid],
    window: &Window,
    out: &mut [Option<Grid>],
    context: &Context,
) -> Result<()> {
    let made = refinement.surface_at(share, &level_of(level, planes)?, window, context.progress)?;
    let [height, flow, lake, surface, receiver] = out else { return Ok(()) };
    if let Some(surface) = surface {
        *surface = made.height.clone();
        for (surface, water) in surface.data_mut().iter_mut().zip(made.water_level.data()) {
            *surface = if water.is_nan() { *surface } else { *water };
        }
    }
    if let Some(receiver) = receiver {
        let codes = receiver.data_mut().iter_mut().zip(made.receiver.data());
        codes.for_each(|(out, code)| *out = f32::from(*code));
    }
    let layers = [(height, made.height), (flow, made.flow), (lake, made.lake_depth)];
    layers.into_iter().for_each(|(out, made)| *out = out.take().map(|_| made));
    Ok(())
}

/// Memory for making a level over a window whose children extend by `halo` beyond it, in bytes.
#[must_use]
pub fn scratch(window: &Window, halo: usize) -> u64 {
    let samples = window.grown(halo);
    Refinement::bytes_per_sample().saturating_mul(samples.width as u64).saturating_mul(samples.height as u64)
}

/// The level of these planes.
///
/// # Errors
/// If the planes are not those of a level.
pub fn level_of(depth: usize, planes: &[Grid]) -> Result<Level> {
    Level::from_planes(depth, &planes.iter().collect::<Vec<_>>())
}
