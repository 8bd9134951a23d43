//! What the levelled ops that make drained land have in common.

use crate::op::{Context, Levels};
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::hydrology::rivers::Channel;
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

/// How layers are read from a level.
pub struct Reading {
    /// Where samples of coarser levels are in their cells, as a share of the sides.
    pub share: f32,
    /// Drainage area of rivers, in m^2.
    pub stream: f64,
    /// Runoff in metres per year.
    pub runoff: f64,
}

/// The layers height, flow, lake, surface, receiver, width and depth.
///
/// # Errors
/// If the planes are not those of a level, or the work was cancelled.
pub fn layers_of(
    refinement: &Refinement,
    reading: &Reading,
    level: usize,
    planes: &[Grid],
    window: &Window,
    out: &mut [Option<Grid>],
    context: &Context,
) -> Result<()> {
    let made = refinement.surface_at(reading.share, &level_of(level, planes)?, window, context.progress)?;
    let [height, flow, lake, surface, receiver, width, depth] = out else { return Ok(()) };
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
    let channel = Channel::default().with_runoff(reading.runoff);
    let sizes: [(_, fn(&Channel, f64) -> f64); 2] = [(width, Channel::width_of), (depth, Channel::depth_of)];
    for (size, of) in sizes {
        let Some(size) = size else { continue };
        for ((size, area), water) in size.data_mut().iter_mut().zip(made.flow.data()).zip(made.water_level.data()) {
            let area = f64::from(*area);
            let river = area >= reading.stream && water.is_nan();
            *size = if river { of(&channel, channel.discharge(area)) as f32 } else { 0.0 };
        }
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
