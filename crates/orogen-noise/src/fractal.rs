//! Fractal sums of octaves.

use crate::basis::Basis;
use crate::builder::noise_builder;
use crate::choices::Kind;
use crate::methods::noise_methods;
use crate::prepared::preparable;
use crate::program::{Octaves, Program};
use crate::tiled::tileable;

/// A sum of octaves of one basis.
///
/// Octave i has the wavelength `wavelength / lacunarity^i`, the amplitude gain^i divided by the sum of all amplitudes,
/// and its own seed and offset, so that the lattices do not coincide at the origin. Range: -1 ..= 1.
///
/// ```
/// use orogen_noise::{Basis, Fractal, Kind};
///
/// let hills = Fractal::new(7, 800.0);
/// let crests = hills.with_kind(Kind::Ridged).with_basis(Basis::Perlin);
/// assert!(hills.sample(10.0, 20.0).abs() <= 1.0 && crests.sample(10.0, 20.0).abs() <= 1.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Fractal {
    /// The noise that is summed. Default [`Basis::Perlin`].
    pub basis: Basis,
    /// The combination of the octaves. Default [`Kind::Fbm`].
    pub kind: Kind,
    /// Any number; neighboring seeds give unrelated noise. Default 0.
    pub seed: u64,
    /// Wavelength of the first octave, in metres. If it is zero or too small to divide by, the noise is constant.
    /// Default 1.
    pub wavelength: f64,
    /// Number of octaves, up to [`crate::MAX_OCTAVES`]; more are ignored. Without octaves the value is 0 (1 for ridged;
    /// -1 for billow, swiss and jordan). Default 6.
    pub octaves: u32,
    /// Frequency ratio from one octave to the next. Default 2.
    pub lacunarity: f64,
    /// Amplitude ratio from one octave to the next, clamped to -1024 ..= 1024; NaN counts as 0. Default 0.5.
    pub gain: f64,
}

impl Default for Fractal {
    fn default() -> Fractal {
        Fractal {
            basis: Basis::Perlin,
            kind: Kind::Fbm,
            seed: 0,
            wavelength: 1.0,
            octaves: 6,
            lacunarity: 2.0,
            gain: 0.5,
        }
    }
}

noise_builder!(
    Fractal: with_basis(basis: Basis),
    with_kind(kind: Kind),
    with_octaves(octaves: u32),
    with_lacunarity(lacunarity: f64),
    with_gain(gain: f64)
);

impl Fractal {
    pub(crate) fn program(&self, dims: usize) -> Program {
        Program::octaves_of(&Octaves {
            source: self.basis.source(),
            bound: self.basis.bound(dims),
            kind: self.kind,
            seed: self.seed,
            wavelength: self.wavelength,
            count: self.octaves,
            lacunarity: self.lacunarity,
            gain: self.gain,
        })
    }
}

noise_methods!(Fractal);
preparable!(Fractal);
tileable!(Fractal);
