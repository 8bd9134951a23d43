//! Fractal sums of octaves.

use crate::basis::Basis;
use crate::classic::ClassicVariant;
use crate::program::{Program, Source};
use crate::value::Fade;

/// How octaves become one number. All kinds are normalised by the sum of the octaves' amplitudes and stay within [-1, 1].
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum Kind {
    /// Fractional Brownian motion: the sum. Its gradient is exact.
    #[default]
    Fbm,
    /// The sum of 1 - 2 |noise|: sharp crests. Its gradient is exact except on the creases.
    Ridged,
    /// The sum of 2 |noise| - 1: sharp valleys, round hills. Its gradient is exact except on the creases.
    Billow,
    /// Each octave is damped by the slope so far, so that detail gathers on the flats and steep ground stays smooth:
    ///
    /// ```text
    /// d += (gain lacunarity)^i grad n_i       slope of the plain sum, per wavelength of the first octave
    /// h += gain^i n_i falloff(k |d|^2)
    /// ```
    ///
    /// With gain 1/2 and lacunarity 2 this is the sum of I. Quilez, "Value noise derivatives" (2008), over any basis.
    /// Its gradient leaves the falloff's own slope out, which would take second derivatives: an approximation, not the
    /// exact slope. White noise has no slope, so over it this is [`Kind::Fbm`].
    Weighted {
        /// Strength of the damping, 0 and up; 0 is [`Kind::Fbm`]. No unit: it means the same at any wavelength. Usual: 1.
        k: f64,
        /// Shape of the damping.
        falloff: Falloff,
    },
}

/// The damping factor of [`Kind::Weighted`] for a squared slope m, 1 at no slope.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Falloff {
    /// 1 / (1 + k m).
    #[default]
    Reciprocal,
    /// e^(-k m).
    Exponential,
    /// 1 / (1 + k sqrt m).
    SquareRoot,
    /// 1 - smoothstep(k m): no detail at all from k m = 1 on.
    Smoothstep,
}

/// Octaves of one basis, each finer and weaker than the one before.
///
/// Octave i has the wavelength `wavelength / lacunarity^i`, the amplitude gain^i over the sum of all amplitudes, and a seed and an
/// offset of its own, so that the lattices do not line up at the origin. Range: within [-1, 1].
///
/// ```
/// use orogen_noise::{Basis, Fractal, Kind};
///
/// let hills = Fractal { wavelength: 800.0, seed: 7, ..Default::default() };
/// let crests = Fractal { kind: Kind::Ridged, basis: Basis::Perlin, ..hills };
/// assert!(hills.sample(10.0, 20.0).abs() <= 1.0 && crests.sample(10.0, 20.0).abs() <= 1.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fractal {
    /// What the octaves are made of. Default [`Basis::Perlin`].
    pub basis: Basis,
    /// How they are summed. Default [`Kind::Fbm`].
    pub kind: Kind,
    /// Any number; neighbouring seeds give unrelated noise. Default 0.
    pub seed: u64,
    /// Wavelength of the first octave, metres. One that is zero, or too small to divide by, gives a constant. Default 1.
    pub wavelength: f64,
    /// How many octaves, up to [`crate::MAX_OCTAVES`]; more are left out. None at all gives the sum of nothing: 0 (1 for
    /// ridged, -1 for billow). Default 6.
    pub octaves: u32,
    /// Frequency ratio from one octave to the next. Default 2.
    pub lacunarity: f64,
    /// Amplitude ratio from one octave to the next, held within -1024 ..= 1024; NaN counts as 0. Default 0.5.
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

impl Fractal {
    fn source(&self) -> Source {
        match self.basis {
            Basis::White => Source::Value(Fade::Step),
            Basis::Value => Source::Value(Fade::Quintic),
            Basis::Perlin => Source::Perlin,
            Basis::ClassicDiagonal => Source::Classic(ClassicVariant::Diagonal),
            Basis::ClassicEight => Source::Classic(ClassicVariant::Eight),
            Basis::ClassicAngle => Source::Classic(ClassicVariant::Angle),
        }
    }
    pub(crate) fn program(&self) -> Program {
        Program::fractal(self.source(), self, self.basis.bound())
    }
    pub(crate) fn program3(&self) -> Program {
        Program::fractal(self.source(), self, self.basis.bound3())
    }
}

crate::methods::noise_methods!(Fractal);
