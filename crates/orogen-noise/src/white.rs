//! White noise.

use crate::choices::Fade;
use crate::methods::noise_methods;
use crate::program::{Program, Source};
use crate::tiled::tileable;

/// White noise: an independent value for every square (in 3D every cube) of a lattice.
///
/// Range: within [-1, 1], uniform. Zero mean. It has no slope; gradients are given as zero.
///
/// ```
/// let noise = orogen_noise::White { seed: 7, wavelength: 1.0 };
/// assert_eq!(noise.sample(12.25, 3.5), noise.sample(12.75, 3.0));
/// assert_ne!(noise.sample(12.25, 3.5), noise.sample(13.25, 3.5));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct White {
    /// Any number; neighbouring seeds give unrelated noise. Default 0.
    pub seed: u64,
    /// Side of a square, metres. Default 1.
    pub wavelength: f64,
}

impl Default for White {
    fn default() -> White {
        White { seed: 0, wavelength: 1.0 }
    }
}

impl White {
    pub(crate) fn program(&self, _: usize) -> Program {
        Program::single(Source::Value(Fade::Step), self.seed, self.wavelength)
    }
}

noise_methods!(White);
tileable!(White);
