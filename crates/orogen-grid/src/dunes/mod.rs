//! Dunes: sand that the wind moves over ground.
//!
//! The continuous model of Sauermann, Kroy and Herrmann (2001) and Kroy, Sauermann and Herrmann (2002), with the
//! simplifications of Schwaemmle and Herrmann (2005): the wind is faster over crests, a little before them; the flux of
//! sand follows the wind over a saturation length; behind crests is a wake without flux; sand steeper than its angle of
//! repose slides. All samples change at once, from the same state, so that the result does not depend on an order.

mod slides;
mod torus;
mod wind;

use crate::error::{Error, ErrorKind, Result};
use crate::grid::{Grid, Window};
use crate::progress::Progress;
use crate::words::number;
use torus::{Heading, Torus};

/// How the wind makes dunes.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Dunes {
    /// Distance between young dunes, in metres.
    pub wavelength: f64,
    /// Flux of sand over level sand, in m^2 per year: volume per width.
    pub flux: f64,
    /// Duration, in years.
    pub years: f64,
    /// Direction that the wind comes from, in degrees clockwise from north.
    pub wind_direction: f64,
    /// Angle between two winds that alternate, in degrees; 0 is one wind.
    pub wind_spread: f64,
    /// Seed of the unevenness of the sand at the beginning.
    pub seed: u64,
}

impl Default for Dunes {
    /// The defaults of the op `dunes`.
    fn default() -> Dunes {
        Dunes { wavelength: 160.0, flux: 100.0, years: 110.0, wind_direction: 270.0, wind_spread: 0.0, seed: 0 }
    }
}

orogen_noise::builder!(
    Dunes:
    with_wavelength(wavelength: f64),
    with_flux(flux: f64),
    with_years(years: f64),
    with_wind_direction(wind_direction: f64),
    with_wind_spread(wind_spread: f64),
    with_seed(seed: u64)
);

/// Ground with dunes.
#[derive(Debug, Clone, PartialEq)]
pub struct SandyGround {
    /// Heights with the sand, in metres.
    pub height: Grid,
    /// Thickness of the sand, in metres.
    pub sand: Grid,
}

/// Duration of a step, in squares of the cell over the flux. Faster steps make ripples of a few cells.
const STEP: f64 = 0.17;

/// Maximum number of steps.
pub const MAX_STEPS: f64 = 50_000.0;

/// Number of steps after which the other of two winds blows.
const SEASON: usize = 20;

/// Wavelength of young dunes over the saturation length: the fastest growing one, 3 pi / [`wind::ASYMMETRY`].
const WAVELENGTH: f64 = 3.0 * std::f64::consts::PI / wind::ASYMMETRY as f64;

impl Dunes {
    /// Number of steps at a cell.
    #[must_use]
    pub fn steps(&self, cell: f64) -> f64 {
        (self.years * self.flux / (STEP * cell * cell)).ceil()
    }

    /// Memory in bytes of [`Dunes::run`] over a window, with its grids.
    #[must_use]
    pub fn memory(&self, window: &Window) -> u64 {
        let torus = Torus::new(window, self.wavelength);
        // The two grids before and after, and the planes of the state and of a step.
        let planes = (torus.len() as u64).saturating_mul(4 * (4 + wind::PLANES as u64));
        (window.len() as u64).saturating_mul(16).saturating_add(planes)
    }

    /// The ground with dunes, from the ground and the mean thickness of its sand at the beginning.
    ///
    /// # Errors
    /// If the grids have different windows, there are more than [`MAX_STEPS`] steps, or the work is cancelled.
    pub fn run(&self, ground: &Grid, sand: &Grid, progress: &Progress) -> Result<SandyGround> {
        let window = *ground.window();
        if *sand.window() != window {
            return Err(Error::new(ErrorKind::Request, "the ground and its sand must have the same window"));
        }
        let steps = self.steps(window.cell);
        if steps > MAX_STEPS {
            let message = format!(
                "dunes of {} years with a flux of {} m^2/yr need {steps} steps at a cell of {} m; at most {MAX_STEPS} are allowed. Use a larger cell or fewer years",
                number(self.years),
                number(self.flux),
                number(window.cell)
            );
            return Err(Error::new(ErrorKind::Request, message));
        }
        if window.is_empty() {
            return Ok(SandyGround { height: ground.clone(), sand: sand.clone() });
        }
        let torus = Torus::new(&window, self.wavelength);
        let finite = |height: f32| if height.is_finite() { height } else { 0.0 };
        let mut land = torus.closed(&ground.data().iter().map(|height| finite(*height)).collect::<Vec<f32>>());
        let mut loose = torus.closed(&self.scattered(sand)?);
        let steps = steps as usize;
        progress.expect(steps as f64 + 1.0);
        let duration = if steps == 0 { 0.0 } else { self.years / steps as f64 };
        let turns: &[f64] = if self.wind_spread == 0.0 { &[0.0] } else { &[-0.5, 0.5] };
        let mut done = 0;
        for turn in turns.iter().cycle() {
            let heading = Heading::from(self.wind_direction + turn * self.wind_spread, &torus);
            (land, loose) = (torus.along(&heading, &land), torus.along(&heading, &loose));
            let mut state = wind::State::new(self, &heading, window.cell, duration, land, loose);
            let season = if turns.len() == 1 { steps } else { SEASON.min(steps - done) };
            for _ in 0..season {
                state.step();
                progress.step(1.0)?;
            }
            state.calm();
            done += season;
            if done == steps {
                state.settle(progress)?;
            }
            (land, loose) = (torus.back(&heading, &state.ground), torus.back(&heading, &state.sand));
            if done == steps {
                break;
            }
        }
        progress.advance(1.0);
        let mut result = SandyGround { height: ground.clone(), sand: Grid::filled(window, 0.0) };
        torus.open(&loose, result.sand.data_mut());
        for (height, sand) in result.height.data_mut().iter_mut().zip(result.sand.data()) {
            *height += sand;
        }
        Ok(result)
    }

    /// The sand at the beginning: uneven, so that dunes begin to grow.
    fn scattered(&self, sand: &Grid) -> Result<Vec<f32>> {
        let window = sand.window();
        let mut uneven = vec![0.0; window.len()];
        let (xs, ys) = (window.eastings(), window.southings());
        orogen_noise::Perlin::new(self.seed, 0.5 * self.wavelength)
            .fill(&orogen_noise::Points::Lattice { xs: &xs, ys: &ys }, &mut uneven)
            .map_err(|error| Error::new(ErrorKind::Internal, error.to_string()))?;
        for (uneven, sand) in uneven.iter_mut().zip(sand.data()) {
            let thickness = if sand.is_finite() { sand.clamp(0.0, 1e4) } else { 0.0 };
            *uneven = thickness * (1.0 + 1.5 * *uneven).max(0.0);
        }
        Ok(uneven)
    }
}

#[cfg(test)]
mod tests;
