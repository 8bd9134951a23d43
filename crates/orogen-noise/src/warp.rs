//! Domain warps.

use crate::basis::Basis;
use crate::builder::noise_builder;
use crate::choices::Kind;
use crate::fractal::Fractal;
use crate::methods::fill;
use crate::points::{LengthMismatch, Points};
use crate::program::Program;
use crate::seed;

/// How a [`Warp`] computes displacements.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum WarpKind {
    /// Two fractals, one for each axis. This is the usual domain warp.
    #[default]
    Independent,
    /// Octave by octave. Each octave is evaluated at the position to which the previous ones displaced the sample.
    Progressive,
    /// Along the gradient of one fractal, per first wavelength: towards its crests and away from its valleys.
    Gradient,
}

/// A domain warp: displacements of positions before another noise is evaluated there.
///
/// Displacements of independent and progressive warps are at most `strength` along each axis. Gradient warps have no
/// simple bound: the slope of Perlin fBm per first wavelength is rarely above 3.
///
/// I. Quilez, "Domain warping" (2002).
///
/// ```
/// use orogen_noise::{Fractal, Points, Warp};
///
/// let axis: Vec<f64> = (0..64).map(f64::from).collect();
/// let (mut dx, mut dy, mut heights) = (vec![0.0; 4096], vec![0.0; 4096], vec![0.0; 4096]);
/// let warp = Warp::default().with_wavelength(50.0).with_strength(20.0);
/// warp.displace(&Points::Lattice { xs: &axis, ys: &axis }, &mut dx, &mut dy)?;
/// let warped = Points::Displaced { xs: &axis, ys: &axis, dx: &dx, dy: &dy };
/// Fractal::default().with_wavelength(30.0).fill(&warped, &mut heights)?;
/// # Ok::<(), orogen_noise::LengthMismatch>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Warp {
    /// The method of computing displacements. Default [`WarpKind::Independent`].
    pub kind: WarpKind,
    /// The noise that is summed. Default [`Basis::Perlin`].
    pub basis: Basis,
    /// Any number; neighboring seeds give unrelated warps. Default 0.
    pub seed: u64,
    /// Wavelength of the first octave, in metres. Default 1.
    pub wavelength: f64,
    /// Number of octaves, up to [`crate::MAX_OCTAVES`]. Default 3.
    pub octaves: u32,
    /// Frequency ratio from one octave to the next. Default 2.
    pub lacunarity: f64,
    /// Amplitude ratio from one octave to the next. Default 0.5.
    pub gain: f64,
    /// Displacement where the noise is 1, in metres. Default 1.
    pub strength: f64,
}

impl Default for Warp {
    fn default() -> Warp {
        Warp {
            kind: WarpKind::Independent,
            basis: Basis::Perlin,
            seed: 0,
            wavelength: 1.0,
            octaves: 3,
            lacunarity: 2.0,
            gain: 0.5,
            strength: 1.0,
        }
    }
}

noise_builder!(
    Warp: with_kind(kind: WarpKind),
    with_basis(basis: Basis),
    with_octaves(octaves: u32),
    with_lacunarity(lacunarity: f64),
    with_gain(gain: f64),
    with_strength(strength: f64)
);

impl Warp {
    /// The displacements of the points along x and y, in metres. For points that are already displaced, these are
    /// further displacements at the displaced positions.
    ///
    /// # Errors
    /// A slice does not have the same length as the points. Nothing is written then.
    pub fn displace(&self, points: &Points, dx: &mut [f32], dy: &mut [f32]) -> Result<(), LengthMismatch> {
        self.prepare().displace(points, dx, dy)
    }

    /// The warp with its tables computed once. It gives the same bits, and does less work per call.
    #[must_use]
    pub fn prepare(&self) -> PreparedWarp {
        let fractal = |seed, wavelength, octaves| Fractal {
            basis: self.basis,
            kind: Kind::Fbm,
            seed,
            wavelength,
            octaves,
            lacunarity: self.lacunarity,
            gain: self.gain,
        };
        let sum = |axis| fractal(seed::octave_seed(self.seed, axis), self.wavelength, self.octaves).program(2);
        let strength = if self.strength.is_nan() { 0.0 } else { self.strength.clamp(-1e30, 1e30) };
        match self.kind {
            WarpKind::Independent => {
                PreparedWarp { kind: self.kind, programs: vec![sum(0), sum(1)], factors: vec![strength as f32] }
            }
            WarpKind::Gradient => {
                let factor = (strength * self.wavelength) as f32;
                let factor = if factor.is_finite() { factor } else { 0.0 };
                PreparedWarp { kind: self.kind, programs: vec![sum(0)], factors: vec![factor] }
            }
            WarpKind::Progressive => {
                let first = seed::octave_seed(self.seed, 0);
                let octaves = self.octaves.min(crate::MAX_OCTAVES);
                let gain = if self.gain.is_finite() { self.gain.clamp(-1024.0, 1024.0) } else { 0.0 };
                let gains = || (0..octaves).scan(1.0, move |next, _| Some(std::mem::replace(next, *next * gain)));
                let total: f64 = gains().map(f64::abs).sum();
                let mut warp = PreparedWarp { kind: self.kind, programs: Vec::new(), factors: Vec::new() };
                let mut wavelength = self.wavelength;
                for (octave, gain) in (0..u64::from(octaves)).zip(gains()) {
                    let one = |axis| fractal(seed::octave_seed(first, 2 * octave + axis), wavelength, 1).program(2);
                    warp.programs.extend([one(0), one(1)]);
                    warp.factors.push((strength * gain / total) as f32);
                    wavelength /= self.lacunarity;
                }
                warp
            }
        }
    }
}

/// A [`Warp`] whose tables of octaves are computed once for many calls. It is created with [`Warp::prepare`]. Any
/// number of threads can use it at the same time.
///
/// ```
/// use orogen_noise::{Points, Warp};
///
/// let warp = Warp::new(7, 50.0).with_strength(20.0);
/// let prepared = warp.prepare();
/// let points = Points::Scattered { x: &[12.5], y: &[-3.0] };
/// let (mut direct, mut twice) = ([[0.0]; 2], [[0.0]; 2]);
/// let [dx, dy] = &mut direct;
/// warp.displace(&points, dx, dy)?;
/// let [dx, dy] = &mut twice;
/// prepared.displace(&points, dx, dy)?;
/// assert_eq!(direct, twice);
/// # Ok::<(), orogen_noise::LengthMismatch>(())
/// ```
#[derive(Clone, Debug)]
pub struct PreparedWarp {
    kind: WarpKind,
    /// One program per axis. With [`WarpKind::Progressive`] one per octave and axis, with [`WarpKind::Gradient`] only
    /// one.
    programs: Vec<Program>,
    /// Factor of the noise. With [`WarpKind::Progressive`] one per octave.
    factors: Vec<f32>,
}

impl PreparedWarp {
    /// [`Warp::displace`] of the prepared warp.
    ///
    /// # Errors
    /// A slice does not have the same length as the points. Nothing is written then.
    pub fn displace(&self, points: &Points, dx: &mut [f32], dy: &mut [f32]) -> Result<(), LengthMismatch> {
        points.check()?;
        LengthMismatch::check("dx", dx.len(), points.len())?;
        LengthMismatch::check("dy", dy.len(), points.len())?;
        match (self.kind, self.programs.as_slice(), self.factors.as_slice()) {
            (WarpKind::Independent, [along, across], &[factor]) => {
                fill(along, points, &[], dx, None)?;
                fill(across, points, &[], dy, None)?;
                scale(dx, factor);
                scale(dy, factor);
            }
            (WarpKind::Gradient, [program], &[factor]) => {
                let mut value = vec![0.0; points.len()];
                fill(program, points, &[], &mut value, Some([&mut *dx, &mut *dy, &mut [], &mut []]))?;
                scale(dx, factor);
                scale(dy, factor);
            }
            _ => self.progress(points, dx, dy)?,
        }
        Ok(())
    }

    fn progress(&self, points: &Points, dx: &mut [f32], dy: &mut [f32]) -> Result<(), LengthMismatch> {
        dx.fill(0.0);
        dy.fill(0.0);
        let (mut x, mut y) = (Vec::new(), Vec::new());
        if !matches!(points, Points::Lattice { .. }) {
            (x, y) = (0..points.len()).filter_map(|k| points.position(k)).unzip();
        }
        let [mut along, mut across] = [vec![0.0; dx.len()], vec![0.0; dy.len()]];
        for (pair, share) in self.programs.chunks_exact(2).zip(&self.factors) {
            for (program, to) in pair.iter().zip([&mut along, &mut across]) {
                match *points {
                    Points::Lattice { xs, ys } => fill(program, &Points::Displaced { xs, ys, dx, dy }, &[], to, None)?,
                    _ => {
                        let moved = |from: &[f64], by: &[f32]| -> Vec<f64> {
                            from.iter().zip(by).map(|(x, by)| x + f64::from(*by)).collect()
                        };
                        let (x, y) = (moved(&x, dx), moved(&y, dy));
                        fill(program, &Points::Scattered { x: &x, y: &y }, &[], to, None)?;
                    }
                }
            }
            for (sum, noise) in dx.iter_mut().zip(&along).chain(dy.iter_mut().zip(&across)) {
                *sum += share * noise;
            }
        }
        Ok(())
    }
}

fn scale(values: &mut [f32], factor: f32) {
    for value in values {
        *value *= factor;
    }
}
