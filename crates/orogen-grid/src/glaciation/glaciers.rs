//! Glaciers on land: the thickness of the ice.

use super::Glaciated;
use super::ends::links;
use crate::error::Result;
use crate::grid::{Grid, Window};
use crate::hydrology::direction::{DISTANCES, strides};
use crate::parallel;
use crate::progress::Progress;

/// Ice that is as thick as its weight makes it flow: H = stress / (rho g f S), with the slope S of the surface and a
/// factor f for the drag of the walls (Nye 1952, 1965). Across a valley the surface is level, so ground is under ice
/// where it is lower than the surface of the glacier that its water flows to.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Glaciers {
    /// Basal shear stress in kPa.
    pub stress: f64,
    /// Thickness of firn on slopes above the equilibrium line, in metres.
    pub firn: f64,
}

impl Default for Glaciers {
    /// The defaults of the op `glaciers`.
    fn default() -> Glaciers {
        Glaciers { stress: 100.0, firn: 12.0 }
    }
}

orogen_noise::builder!(Glaciers: with_stress(stress: f64), with_firn(firn: f64));

/// Density of ice times gravity, in kPa per metre.
const WEIGHT: f64 = 0.917 * 9.81;
/// The factor for the drag of the walls.
const SHAPE: f64 = 0.8;
/// Least slope of a surface: ice on level ground is not without bounds.
const MIN_SLOPE: f32 = 0.04;
/// Distance over which the slope is measured, in metres, up and down the valley.
const SLOPE_LENGTH: f64 = 600.0;
/// Distance over which thick ice down the valley holds back the ice above it, in metres, and the least slope there.
const BACKWATER: f64 = 1200.0;
const MIN_FALL: f32 = 0.01;
/// Distance in metres up from a glacier from which ground may be under its ice.
const REACH: f64 = 1800.0;
/// Ice in km^2 at the end of a glacier, and from which on it is as thick as its slope allows.
const SIZES: [f32; 2] = [0.2, 2.0];
/// Heights above the equilibrium line in metres over which firn grows to its thickness.
const FIRN_LINE: f32 = 200.0;
/// Slopes on which firn becomes thinner, and from which on there is none.
const FIRN_SLOPES: [f32; 2] = [0.6, 0.95];
/// Passes in which the surface becomes smooth.
const PASSES: usize = 8;
/// The greatest slope of ice above ground or ice beside it.
const MAX_SLOPE: f32 = 0.6;

impl Glaciers {
    /// Number of samples around a window that [`Glaciers::run`] reads.
    #[must_use]
    pub fn halo(&self, cell: f64) -> usize {
        links(REACH, cell) + links(BACKWATER, cell) + links(SLOPE_LENGTH, cell) + PASSES + 2
    }

    /// The thickness of the ice in metres, 0 where there is none, over a window that is smaller by [`Glaciers::halo`]
    /// on each side.
    ///
    /// # Errors
    /// If the grids have different windows, or the work is cancelled.
    pub fn run(&self, land: &Glaciated, progress: &Progress) -> Result<Grid> {
        let window = land.window()?;
        progress.expect(4.0);
        let surface = self.surface_of_lines(land, progress)?;
        progress.step(1.0)?;
        let mut thickness = self.thickness(land, &surface, progress)?;
        progress.step(2.0)?;
        for _ in 0..PASSES {
            thickness = levelled(land.height, &thickness, progress)?;
        }
        progress.step(1.0)?;
        let inner = window.shrunk(self.halo(window.cell));
        Ok(thickness.crop(&inner).unwrap_or_else(|| Grid::filled(inner, f32::NAN)))
    }

    /// Height of the ice on the samples that it passes; NaN elsewhere. It falls along the valley.
    fn surface_of_lines(&self, land: &Glaciated, progress: &Progress) -> Result<Vec<f32>> {
        let (window, follow) = (*land.height.window(), Follow::new(land));
        let count = links(SLOPE_LENGTH, window.cell);
        let own = along_rows(&window, progress, |q| self.own_surface(land, &follow, q, count))?;
        let count = links(BACKWATER, window.cell);
        along_rows(&window, progress, |q| {
            let (mut at, mut length, mut highest) = (q, 0.0, own[q]);
            for _ in 0..count {
                let Some((next, step)) = follow.next(at).filter(|_| !highest.is_nan()) else { break };
                (at, length) = (next, length + step);
                highest = highest.max(own[at] + MIN_FALL * length);
            }
            highest
        })
    }

    /// Height of the ice at a sample by the slope of its own valley.
    fn own_surface(&self, land: &Glaciated, follow: &Follow, q: usize, count: usize) -> f32 {
        let (heights, ice) = (land.height.data(), land.ice.data()[q] * 1e-6);
        let Some((mut at, mut length)) = follow.next(q).filter(|_| ice >= SIZES[0]) else { return f32::NAN };
        for _ in 1..count {
            let Some((next, step)) = follow.next(at) else { break };
            (at, length) = (next, length + step);
        }
        let slope = ((heights[q] - heights[at]) / length).max(MIN_SLOPE);
        let thick = (self.stress / (WEIGHT * SHAPE)) as f32 / slope;
        let size = ((ice - SIZES[0]) / (SIZES[1] - SIZES[0])).clamp(0.0, 1.0).sqrt();
        heights[q] + thick * size
    }

    /// The thickness of glaciers and firn.
    fn thickness(&self, land: &Glaciated, surface: &[f32], progress: &Progress) -> Result<Grid> {
        let window = *land.height.window();
        let (width, count) = (window.width, links(REACH, window.cell));
        let (heights, follow) = (land.height.data(), Follow::new(land));
        let mut out = Grid::filled(window, 0.0f32);
        let rows = out.data_mut().chunks_mut(width.max(1)).enumerate();
        parallel::try_for_each(rows, |(j, row)| {
            progress.check()?;
            for (i, thickness) in row.iter_mut().enumerate() {
                let q = j * width + i;
                let mut at = q;
                for _ in 0..count {
                    if !surface[at].is_nan() {
                        *thickness = (surface[at] - heights[q]).max(0.0);
                        break;
                    }
                    let Some((next, _)) = follow.next(at) else { break };
                    at = next;
                }
                if i > 0 && j > 0 && i + 1 < width && j + 1 < window.height {
                    let gradient = [heights[q + 1] - heights[q - 1], heights[q + width] - heights[q - width]];
                    let slope =
                        (gradient[0] * gradient[0] + gradient[1] * gradient[1]).sqrt() / (2.0 * window.cell as f32);
                    let high = ((heights[q] - land.equilibrium_line.data()[q]) / FIRN_LINE).clamp(0.0, 1.0);
                    let gentle = ((FIRN_SLOPES[1] - slope) / (FIRN_SLOPES[1] - FIRN_SLOPES[0])).clamp(0.0, 1.0);
                    *thickness = thickness.max(self.firn as f32 * high * gentle);
                }
            }
            Ok(())
        })?;
        Ok(out)
    }
}

/// A value for each sample of a window.
fn along_rows(window: &Window, progress: &Progress, of: impl Fn(usize) -> f32 + Sync) -> Result<Vec<f32>> {
    let rows = (0..window.height).map(|j| j * window.width..(j + 1) * window.width);
    let rows = parallel::try_map(rows, |row| {
        progress.check()?;
        Ok(row.map(&of).collect::<Vec<_>>())
    })?;
    Ok(rows.concat())
}

/// Flow directions of a land.
struct Follow<'a> {
    receiver: &'a Grid,
    steps: [isize; 8],
    lengths: [f32; 8],
}

impl Follow<'_> {
    fn new<'a>(land: &Glaciated<'a>) -> Follow<'a> {
        let cell = land.height.window().cell as f32;
        let lengths = DISTANCES.map(|distance| distance as f32 * cell);
        Follow { receiver: land.receiver, steps: strides(land.height.width()), lengths }
    }

    /// The receiver of a sample and its distance in metres; `None` without a receiver, and on the border.
    fn next(&self, q: usize) -> Option<(usize, f32)> {
        let (width, code) = (self.receiver.width(), self.receiver.data()[q]);
        let (i, j) = (q % width, q / width);
        let is_inside = i > 0 && j > 0 && i + 1 < width && j + 1 < self.receiver.height();
        if !is_inside || !(0.0..8.0).contains(&code) {
            return None;
        }
        let code = code as usize & 7;
        Some((q.wrapping_add_signed(self.steps[code]), self.lengths[code]))
    }
}

/// The thickness after a pass in which the surface of the ice becomes smooth, and not too steep.
fn levelled(ground: &Grid, thickness: &Grid, progress: &Progress) -> Result<Grid> {
    let (width, height) = (ground.width(), ground.height());
    let rise = MAX_SLOPE * ground.window().cell as f32;
    let (steps, rises) = (strides(width), DISTANCES.map(|distance| rise * distance as f32));
    let mut out = thickness.clone();
    let rows = out.data_mut().chunks_mut(width.max(1)).enumerate().skip(1).take(height.saturating_sub(2));
    parallel::try_for_each(rows, |(j, row)| {
        progress.check()?;
        for (i, out) in row.iter_mut().enumerate().skip(1).take(width.saturating_sub(2)) {
            let q = j * width + i;
            let (here, thick) = (ground.data()[q], thickness.data()[q]);
            if thick <= 0.0 {
                continue;
            }
            let (mut sum, mut count, mut bound) = (0.0, 0.0, f32::INFINITY);
            for (step, rise) in steps.iter().zip(rises) {
                let next = q.wrapping_add_signed(*step);
                let (surface, thick) = (ground.data()[next] + thickness.data()[next], thickness.data()[next]);
                bound = bound.min(surface + rise);
                if thick > 0.0 {
                    (sum, count) = (sum + surface, count + 1.0);
                }
            }
            let mean = if count > 0.0 { 0.5 * (here + thick) + 0.5 * sum / count } else { here + thick };
            *out = (mean.min(bound) - here).max(0.0);
        }
        Ok(())
    })?;
    Ok(out)
}
