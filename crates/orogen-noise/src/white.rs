//! White noise.

use crate::builder::noise_builder;
use crate::choices::Fade;
use crate::methods::noise_methods;
use crate::prepared::preparable;
use crate::program::{Program, Source};
use crate::tiled::tileable;

/// White noise: an independent value for every square (cube in 3D) of a lattice.
///
/// Range: -1 ..= 1, uniform. Zero mean. Methods that return gradients return zeros.
///
/// ```
/// let noise = orogen_noise::White::new(7, 1.0);
/// assert_eq!(noise.sample(12.25, 3.5), noise.sample(12.75, 3.0));
/// assert_ne!(noise.sample(12.25, 3.5), noise.sample(13.25, 3.5));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct White {
    /// Any number; neighboring seeds give unrelated noise. Default 0.
    pub seed: u64,
    /// Side of a square, in metres. Default 1.
    pub wavelength: f64,
}

impl Default for White {
    fn default() -> White {
        White { seed: 0, wavelength: 1.0 }
    }
}

noise_builder!(White);

impl White {
    pub(crate) fn program(&self, _: usize) -> Program {
        Program::single(Source::Value(Fade::Step), self.seed, self.wavelength)
    }
}

noise_methods!(White);
preparable!(White);
tileable!(White);
