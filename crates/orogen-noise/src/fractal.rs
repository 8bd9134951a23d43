//! Fractal sums of octaves.

use crate::basis::Basis;
use crate::choices::{ClassicVariant, Fade, Feature, Kind, Smoothness};
use crate::methods::noise_methods;
use crate::program::{Octaves, Program, Source};
use crate::tiled::tileable;
use crate::worley::Worley;

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
    /// ridged; -1 for billow, swiss and jordan). Default 6.
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
            Basis::Simplex => Source::Simplex,
            Basis::OpenSimplex2 => Source::OpenSimplex2(Smoothness::Fast),
            Basis::OpenSimplex2Smooth => Source::OpenSimplex2(Smoothness::Smooth),
            Basis::Worley => Source::Worley(Worley::default().cellular()),
            Basis::WorleyEdge => Source::Worley(Worley { feature: Feature::Edge, ..Worley::default() }.cellular()),
        }
    }
    pub(crate) fn program(&self, dims: usize) -> Program {
        Program::octaves_of(&Octaves {
            source: self.source(),
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
tileable!(Fractal);
