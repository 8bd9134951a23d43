//! Phacelle noise.

use crate::kernel::phacelle::{Along, Fill};
use crate::points::{LengthMismatch, Points};
use crate::program::{MAX_PERIOD, Program, Source};
use orogen_simd::{Level, LevelError, dispatch, dispatch_at};

/// Phacelle noise: stripes that run along a direction of the caller's, each sample its own, and join where directions change. With the
/// slope of a terrain as direction they are gullies.
///
/// Cells hold a pivot each, within half a cell of their lattice point, with a plane wave of random phase through it; a sample is the mean of
/// the waves of the 4 x 4 pivots around it, weighted by max(0, e^(-2 d^2) - e^(-4.5)) at distance d in cells, made longer towards length 1:
///
/// ```text
/// wave = sum w (cos phi, sin phi) / sum w,   phi = 2 pi (v . side / wavelength + phase)
/// result = wave / max(1 - normalisation, |wave|)
/// ```
///
/// with v from the pivot to the sample and `side` perpendicular to the direction. Pivots beyond the 4 x 4 have no weight: no seams.
///
/// Range: both parts within [-1, 1]. Zero mean. There is no exact gradient, as directions are the caller's; across the stripes the slope
/// of the cosine is about -2 pi / wavelength times the sine. In the plane only.
///
/// R. Skovbo Johansen, "Phacelle noise" (2025).
///
/// ```
/// use orogen_noise::{Phacelle, Points};
///
/// let stripes = Phacelle { wavelength: 100.0, ..Default::default() };
/// let (xs, ys) = ([0.0, 50.0], [0.0]);
/// let points = Points::Lattice { xs: &xs, ys: &ys };
/// let (mut cosine, mut sine) = ([0.0; 2], [0.0; 2]);
/// // One sample's stripes run east, the other's south.
/// stripes.fill_along(&points, &[1.0, 0.0], &[0.0, 1.0], &mut cosine, &mut sine)?;
/// assert!(cosine.iter().chain(&sine).all(|x| x.abs() <= 1.0));
/// # Ok::<(), orogen_noise::LengthMismatch>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Phacelle {
    /// Any number; neighbouring seeds give unrelated noise. Default 0.
    pub seed: u64,
    /// Distance from stripe to stripe, metres. Default 1.
    pub wavelength: f64,
    /// Side of a cell in wavelengths: how far a stripe goes before it may end. Default 0.7.
    pub cell: f64,
    /// How far waves that cancel each other are made longer, 0 (not at all) to 1 (to full height); held within. Default 0.5.
    pub normalisation: f64,
    /// The way of the stripes where samples bring none: an angle from x (east) towards y (south), degrees. Default 0.
    pub direction: f64,
    /// After how many cells the noise repeats along x and y; 0 where it need not. At most 2^26. Default [0, 0].
    pub period: [u32; 2],
}

impl Default for Phacelle {
    fn default() -> Phacelle {
        Phacelle { seed: 0, wavelength: 1.0, cell: 0.7, normalisation: 0.5, direction: 0.0, period: [0; 2] }
    }
}

impl Phacelle {
    fn program(&self) -> Program {
        let program = Program::single(Source::Perlin, self.seed, self.wavelength * self.cell);
        let [x, y] = self.period.map(|cells| cells.min(MAX_PERIOD as u32));
        // A period held so far down always fits.
        program.tiled([x, y, 0, 0]).unwrap_or(program)
    }

    fn call<'a>(
        &self,
        program: &'a Program,
        points: &Points<'a>,
        along: Along<'a>,
        [cosine, sine]: [&'a mut [f32]; 2],
    ) -> Fill<'a> {
        let normalisation = if self.normalisation >= 0.0 { self.normalisation.min(1.0) } else { 0.0 };
        // Never 0: waves that cancel each other exactly stay as they are.
        let shortest = ((1.0 - normalisation) as f32).max(1e-6);
        let stripes = if self.cell.is_finite() { self.cell.clamp(-1e6, 1e6) as f32 } else { 0.0 };
        Fill { program, points: *points, along, stripes, shortest, cosine, sine }
    }

    fn way(&self) -> Along<'static> {
        let angle = self.direction.to_radians();
        let way = [libm::cos(angle) as f32, libm::sin(angle) as f32];
        Along::One(if way[0].is_finite() { way } else { [1.0, 0.0] })
    }

    /// The cosine at (x, y), metres, of stripes along [`Phacelle::direction`].
    #[must_use]
    pub fn sample(&self, x: f64, y: f64) -> f32 {
        let mut value = [0.0];
        // The lengths agree, so there is no error to hand on.
        let _ = self.fill(&Points::Scattered { x: &[x], y: &[y] }, &mut value);
        value[0]
    }

    /// The cosines at the points, of stripes along [`Phacelle::direction`].
    ///
    /// # Errors
    /// A slice does not have the points' length; nothing is written.
    pub fn fill(&self, points: &Points, value: &mut [f32]) -> Result<(), LengthMismatch> {
        points.check()?;
        LengthMismatch::check("value", value.len(), points.len())?;
        dispatch(self.call(&self.program(), points, self.way(), [value, &mut []]));
        Ok(())
    }

    /// Cosines and sines at the points, of stripes along (dx, dy), a way for each sample; its length does not matter, and one of no
    /// length makes no stripes.
    ///
    /// # Errors
    /// A slice does not have the points' length; nothing is written.
    pub fn fill_along(
        &self,
        points: &Points,
        dx: &[f32],
        dy: &[f32],
        cosine: &mut [f32],
        sine: &mut [f32],
    ) -> Result<(), LengthMismatch> {
        self.check(points, dx, dy, cosine, sine)?;
        dispatch(self.call(&self.program(), points, Along::Each([dx, dy]), [cosine, sine]));
        Ok(())
    }

    /// [`fill_along`](Phacelle::fill_along) at a chosen SIMD level, for tests and bug reports: the bits are the same.
    ///
    /// # Errors
    /// This machine lacks the level; inside, a slice of the wrong length.
    pub fn fill_along_at(
        &self,
        level: Level,
        points: &Points,
        [dx, dy]: [&[f32]; 2],
        [cosine, sine]: [&mut [f32]; 2],
    ) -> Result<Result<(), LengthMismatch>, LevelError> {
        if let Err(mismatch) = self.check(points, dx, dy, cosine, sine) {
            return Ok(Err(mismatch));
        }
        dispatch_at(level, self.call(&self.program(), points, Along::Each([dx, dy]), [cosine, sine]))?;
        Ok(Ok(()))
    }

    fn check(
        &self,
        points: &Points,
        dx: &[f32],
        dy: &[f32],
        cosine: &[f32],
        sine: &[f32],
    ) -> Result<(), LengthMismatch> {
        points.check()?;
        for (name, slice) in [("dx", dx), ("dy", dy), ("cosine", cosine), ("sine", sine)] {
            LengthMismatch::check(name, slice.len(), points.len())?;
        }
        Ok(())
    }
}
