//! Domain warps.

use crate::basis::Basis;
use crate::choices::Kind;
use crate::fractal::Fractal;
use crate::points::{LengthMismatch, Points};
use crate::seed;

/// How a [`Warp`] moves places.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum WarpKind {
    /// By two fractals, one for each axis: what is usually meant by a domain warp.
    #[default]
    Independent,
    /// Octave by octave, each asked at the place that the ones before it have led to: folds on folds.
    Progressive,
    /// Along the slope of one fractal, per first wavelength: towards its crests, and away from its valleys.
    Gradient,
}

/// A domain warp: how far each place is moved before another noise is asked there.
///
/// Independent and progressive warps move no farther than `strength` along each axis. Gradient warps have no simple bound: the slope of
/// fBm over Perlin noise per first wavelength is seldom above 3.
///
/// I. Quilez, "Domain warping" (2002).
///
/// ```
/// use orogen_noise::{Fractal, Points, Warp};
///
/// let axis: Vec<f64> = (0..64).map(f64::from).collect();
/// let (mut dx, mut dy, mut heights) = (vec![0.0; 4096], vec![0.0; 4096], vec![0.0; 4096]);
/// let warp = Warp { wavelength: 50.0, strength: 20.0, ..Default::default() };
/// warp.displace(&Points::Lattice { xs: &axis, ys: &axis }, &mut dx, &mut dy)?;
/// let warped = Points::Displaced { xs: &axis, ys: &axis, dx: &dx, dy: &dy };
/// Fractal { wavelength: 30.0, ..Default::default() }.fill(&warped, &mut heights)?;
/// # Ok::<(), orogen_noise::LengthMismatch>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Warp {
    /// How places are moved. Default [`WarpKind::Independent`].
    pub kind: WarpKind,
    /// What the octaves are made of. Default [`Basis::Perlin`].
    pub basis: Basis,
    /// Any number; neighbouring seeds give unrelated warps. Default 0.
    pub seed: u64,
    /// Wavelength of the first octave, metres. Default 1.
    pub wavelength: f64,
    /// How many octaves, up to [`crate::MAX_OCTAVES`]. Default 3.
    pub octaves: u32,
    /// Frequency ratio from one octave to the next. Default 2.
    pub lacunarity: f64,
    /// Amplitude ratio from one octave to the next. Default 0.5.
    pub gain: f64,
    /// How far a noise of 1 moves a place, metres. Default 1.
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

impl Warp {
    /// How far each of the points is moved along x and y, metres. Points that are displaced already are asked where they are; what is
    /// given is the further displacement.
    ///
    /// # Errors
    /// A slice does not have the points' length; nothing is written.
    pub fn displace(&self, points: &Points, dx: &mut [f32], dy: &mut [f32]) -> Result<(), LengthMismatch> {
        points.check()?;
        LengthMismatch::check("dx", dx.len(), points.len())?;
        LengthMismatch::check("dy", dy.len(), points.len())?;
        let strength = if self.strength.is_nan() { 0.0 } else { self.strength.clamp(-1e30, 1e30) };
        let fractal = |which: u64| Fractal {
            basis: self.basis,
            kind: Kind::Fbm,
            seed: seed::octave_seed(self.seed, which),
            wavelength: self.wavelength,
            octaves: self.octaves,
            lacunarity: self.lacunarity,
            gain: self.gain,
        };
        match self.kind {
            WarpKind::Independent => {
                fractal(0).fill(points, dx)?;
                fractal(1).fill(points, dy)?;
                scale(dx, strength as f32);
                scale(dy, strength as f32);
            }
            WarpKind::Gradient => {
                let mut value = vec![0.0; points.len()];
                fractal(0).fill_with_gradient(points, &mut value, dx, dy)?;
                let factor = (strength * self.wavelength) as f32;
                let factor = if factor.is_finite() { factor } else { 0.0 };
                scale(dx, factor);
                scale(dy, factor);
            }
            WarpKind::Progressive => self.progress(points, fractal(0), strength, dx, dy)?,
        }
        Ok(())
    }

    fn progress(
        &self,
        points: &Points,
        like: Fractal,
        strength: f64,
        dx: &mut [f32],
        dy: &mut [f32],
    ) -> Result<(), LengthMismatch> {
        dx.fill(0.0);
        dy.fill(0.0);
        let octaves = self.octaves.min(crate::MAX_OCTAVES);
        let gain = if self.gain.is_finite() { self.gain.clamp(-1024.0, 1024.0) } else { 0.0 };
        let gains = || (0..octaves).scan(1.0, move |next, _| Some(std::mem::replace(next, *next * gain)));
        let total: f64 = gains().map(f64::abs).sum();
        let (mut x, mut y) = (Vec::new(), Vec::new());
        if !matches!(points, Points::Lattice { .. }) {
            (x, y) = (0..points.len()).filter_map(|k| points.position(k)).unzip();
        }
        let mut wavelength = self.wavelength;
        let [mut along, mut across] = [vec![0.0; dx.len()], vec![0.0; dy.len()]];
        for (octave, gain) in (0..u64::from(octaves)).zip(gains()) {
            let one = |which| Fractal {
                seed: seed::octave_seed(like.seed, 2 * octave + which),
                wavelength,
                octaves: 1,
                ..like
            };
            for (which, to) in [(0, &mut along), (1, &mut across)] {
                match *points {
                    Points::Lattice { xs, ys } => one(which).fill(&Points::Displaced { xs, ys, dx, dy }, to)?,
                    _ => {
                        let moved = |from: &[f64], by: &[f32]| -> Vec<f64> {
                            from.iter().zip(by).map(|(x, by)| x + f64::from(*by)).collect()
                        };
                        one(which).fill(&Points::Scattered { x: &moved(&x, dx), y: &moved(&y, dy) }, to)?;
                    }
                }
            }
            let share = (strength * gain / total) as f32;
            for (sum, noise) in dx.iter_mut().zip(&along).chain(dy.iter_mut().zip(&across)) {
                *sum += share * noise;
            }
            wavelength /= self.lacunarity;
        }
        Ok(())
    }
}

fn scale(values: &mut [f32], factor: f32) {
    for value in values {
        *value *= factor;
    }
}
