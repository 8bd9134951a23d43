//! Phacelle noise.

use crate::builder::noise_builder;
use crate::kernel::phacelle::{Along, Fill};
use crate::points::{LengthMismatch, Points};
use crate::program::{MAX_PERIOD, Program, Source};
use orogen_simd::{Level, LevelError, dispatch, dispatch_at};

/// Phacelle noise: stripes along a direction that the caller gives for each sample. Stripes merge where directions
/// change. If they follow the slope of a terrain, they look like gullies.
///
/// Each cell has a pivot within half a cell of its lattice point. The pivot has a plane wave with a random phase. A
/// sample is the mean of the waves of the 4 x 4 pivots around it, weighted by max(0, e^(-2 d^2) - e^(-4.5)) at distance
/// d in cells. The mean is then lengthened towards length 1:
///
/// ```text
/// wave = sum w (cos phi, sin phi) / sum w,   phi = 2 pi (v . side / wavelength + phase)
/// result = wave / max(1 - normalisation, |wave|)
/// ```
///
/// where v is the vector from the pivot to the sample, and `side` is perpendicular to the direction. Other pivots have
/// a weight of 0, so there are no discontinuities.
///
/// Range: -1 ..= 1 for cosine and sine. Zero mean. There is no exact gradient, because it would need the derivatives of
/// the directions. Across the stripes the slope of the cosine is about -2 pi / wavelength times the sine. Only two
/// dimensions are supported.
///
/// R. Skovbo Johansen, "Phacelle noise" (2025).
///
/// ```
/// use orogen_noise::{Phacelle, Points};
///
/// let stripes = Phacelle::default().with_wavelength(100.0);
/// let (xs, ys) = ([0.0, 50.0], [0.0]);
/// let points = Points::Lattice { xs: &xs, ys: &ys };
/// let (mut cosine, mut sine) = ([0.0; 2], [0.0; 2]);
/// // The stripes of one sample run east, those of the other south.
/// stripes.fill_along(&points, &[1.0, 0.0], &[0.0, 1.0], &mut cosine, &mut sine)?;
/// assert!(cosine.iter().chain(&sine).all(|x| x.abs() <= 1.0));
/// # Ok::<(), orogen_noise::LengthMismatch>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Phacelle {
    /// Any number; neighboring seeds give unrelated noise. Default 0.
    pub seed: u64,
    /// Distance from stripe to stripe, in metres. Default 1.
    pub wavelength: f64,
    /// Side of a cell, in wavelengths. It limits the length of a stripe. Default 0.7.
    pub cell: f64,
    /// How much waves that cancel each other are lengthened, from 0 (not at all) to 1 (to full height); clamped.
    /// Default 0.5.
    pub normalisation: f64,
    /// Direction of the stripes for methods without directions: an angle from x (east) towards y (south), in degrees.
    /// Default 0.
    pub direction: f64,
    /// Period along x and y in cells, at most 2^26; 0 along axes without a period. Default [0, 0].
    pub period: [u32; 2],
}

impl Default for Phacelle {
    fn default() -> Phacelle {
        Phacelle { seed: 0, wavelength: 1.0, cell: 0.7, normalisation: 0.5, direction: 0.0, period: [0; 2] }
    }
}

noise_builder!(
    Phacelle: with_cell(cell: f64),
    with_normalisation(normalisation: f64),
    with_direction(direction: f64),
    with_period(period: [u32; 2])
);

impl Phacelle {
    fn program(&self) -> Program {
        let program = Program::single(Source::Perlin, self.seed, self.wavelength * self.cell);
        let [x, y] = self.period.map(|cells| cells.min(MAX_PERIOD as u32));
        // A period up to this limit is always possible.
        program.tiled([x, y, 0, 0]).unwrap_or(program)
    }

    /// The noise with its tables computed once. It has the same methods and bits, and does less work per call.
    #[must_use]
    pub fn prepare(&self) -> PreparedPhacelle {
        let angle = self.direction.to_radians();
        let direction = [libm::cos(angle) as f32, libm::sin(angle) as f32];
        self.towards(if direction[0].is_finite() { direction } else { [1.0, 0.0] })
    }

    fn towards(&self, direction: [f32; 2]) -> PreparedPhacelle {
        let normalisation = if self.normalisation >= 0.0 { self.normalisation.min(1.0) } else { 0.0 };
        PreparedPhacelle {
            program: self.program(),
            // Never 0, so that waves that cancel each other exactly are unchanged.
            shortest: ((1.0 - normalisation) as f32).max(1e-6),
            stripes: if self.cell.is_finite() { self.cell.clamp(-1e6, 1e6) as f32 } else { 0.0 },
            direction,
        }
    }

    /// The cosine at (x, y), in metres, of stripes along [`Phacelle::direction`]. Each call computes the tables of the
    /// noise; [`prepare`](Self::prepare) computes them once for many calls.
    #[must_use]
    pub fn sample(&self, x: f64, y: f64) -> f32 {
        self.prepare().sample(x, y)
    }

    /// The cosines at the points, of stripes along [`Phacelle::direction`].
    ///
    /// # Errors
    /// A slice does not have the same length as the points. Nothing is written then.
    pub fn fill(&self, points: &Points, value: &mut [f32]) -> Result<(), LengthMismatch> {
        self.prepare().fill(points, value)
    }

    /// The cosines and sines at the points, of stripes along (dx, dy), with one direction for each sample. The length
    /// of a direction does not matter; a direction of length 0 gives no stripes.
    ///
    /// # Errors
    /// A slice does not have the same length as the points. Nothing is written then.
    pub fn fill_along(
        &self,
        points: &Points,
        dx: &[f32],
        dy: &[f32],
        cosine: &mut [f32],
        sine: &mut [f32],
    ) -> Result<(), LengthMismatch> {
        // The direction of the prepared noise is not used.
        self.towards([1.0, 0.0]).fill_along(points, dx, dy, cosine, sine)
    }

    /// [`fill_along`](Phacelle::fill_along) at a given SIMD level, for tests and bug reports. The bits are the same.
    ///
    /// # Errors
    /// This machine does not support the level. The inner error is a slice of the wrong length.
    pub fn fill_along_at(
        &self,
        level: Level,
        points: &Points,
        directions: [&[f32]; 2],
        results: [&mut [f32]; 2],
    ) -> Result<Result<(), LengthMismatch>, LevelError> {
        self.towards([1.0, 0.0]).fill_along_at(level, points, directions, results)
    }
}

/// [`Phacelle`] noise whose tables are computed once for many calls. It is created with [`Phacelle::prepare`]. Any
/// number of threads can use it at the same time.
///
/// ```
/// let stripes = orogen_noise::Phacelle::new(7, 100.0).with_direction(30.0);
/// let prepared = stripes.prepare();
/// assert_eq!(prepared.sample(12.5, -3.0), stripes.sample(12.5, -3.0));
/// ```
#[derive(Clone, Debug)]
pub struct PreparedPhacelle {
    program: Program,
    /// Side of a cell, in wavelengths.
    stripes: f32,
    /// Minimum length that a wave is divided by.
    shortest: f32,
    /// Direction of the stripes where samples have no direction.
    direction: [f32; 2],
}

impl PreparedPhacelle {
    pub(crate) fn program(&self) -> &Program {
        &self.program
    }

    /// Stripes per cell, and the minimum length that a wave is divided by.
    pub(crate) fn wave(&self) -> [f32; 2] {
        [self.stripes, self.shortest]
    }

    /// [`Phacelle::sample`] of the prepared noise.
    #[must_use]
    pub fn sample(&self, x: f64, y: f64) -> f32 {
        let mut value = [0.0];
        // The lengths match, so there is no error to return.
        let _ = self.fill(&Points::Scattered { x: &[x], y: &[y] }, &mut value);
        value[0]
    }

    /// [`Phacelle::fill`] of the prepared noise.
    ///
    /// # Errors
    /// A slice does not have the same length as the points. Nothing is written then.
    pub fn fill(&self, points: &Points, value: &mut [f32]) -> Result<(), LengthMismatch> {
        points.check()?;
        LengthMismatch::check("value", value.len(), points.len())?;
        dispatch(self.call(points, Along::One(self.direction), [value, &mut []]));
        Ok(())
    }

    /// [`Phacelle::fill_along`] of the prepared noise.
    ///
    /// # Errors
    /// A slice does not have the same length as the points. Nothing is written then.
    pub fn fill_along(
        &self,
        points: &Points,
        dx: &[f32],
        dy: &[f32],
        cosine: &mut [f32],
        sine: &mut [f32],
    ) -> Result<(), LengthMismatch> {
        check(points, dx, dy, cosine, sine)?;
        dispatch(self.call(points, Along::Each([dx, dy]), [cosine, sine]));
        Ok(())
    }

    /// [`Phacelle::fill_along_at`] of the prepared noise.
    ///
    /// # Errors
    /// This machine does not support the level. The inner error is a slice of the wrong length.
    pub fn fill_along_at(
        &self,
        level: Level,
        points: &Points,
        [dx, dy]: [&[f32]; 2],
        [cosine, sine]: [&mut [f32]; 2],
    ) -> Result<Result<(), LengthMismatch>, LevelError> {
        if let Err(mismatch) = check(points, dx, dy, cosine, sine) {
            return Ok(Err(mismatch));
        }
        dispatch_at(level, self.call(points, Along::Each([dx, dy]), [cosine, sine]))?;
        Ok(Ok(()))
    }

    fn call<'a>(&'a self, points: &Points<'a>, along: Along<'a>, [cosine, sine]: [&'a mut [f32]; 2]) -> Fill<'a> {
        let PreparedPhacelle { program, stripes, shortest, .. } = self;
        Fill { program, points: *points, along, stripes: *stripes, shortest: *shortest, cosine, sine }
    }
}

fn check(points: &Points, dx: &[f32], dy: &[f32], cosine: &[f32], sine: &[f32]) -> Result<(), LengthMismatch> {
    points.check()?;
    for (name, slice) in [("dx", dx), ("dy", dy), ("cosine", cosine), ("sine", sine)] {
        LengthMismatch::check(name, slice.len(), points.len())?;
    }
    Ok(())
}
