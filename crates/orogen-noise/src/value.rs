//! Value noise.

use crate::choices::Fade;
use crate::methods::noise_methods;
use crate::program::{Program, Source};
use crate::tiled::tileable;

/// Value noise: random values on a square lattice, blended in between.
///
/// Range: within [-1, 1], both reached. Zero mean. Its gradient is exact (of the linear fade: except on the lattice lines).
/// Cheaper than [`crate::Perlin`], with more visible squares.
///
/// ```
/// let noise = orogen_noise::Value { seed: 7, wavelength: 100.0, ..Default::default() };
/// assert!(noise.sample(12.5, -3.0).abs() <= 1.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Value {
    /// Any number; neighbouring seeds give unrelated noise. Default 0.
    pub seed: u64,
    /// Distance between lattice points, metres. Default 1.
    pub wavelength: f64,
    /// The blend. Default [`Fade::Quintic`].
    pub fade: Fade,
}

impl Default for Value {
    fn default() -> Value {
        Value { seed: 0, wavelength: 1.0, fade: Fade::Quintic }
    }
}

impl Value {
    pub(crate) fn program(&self, _: usize) -> Program {
        Program::single(Source::Value(self.fade), self.seed, self.wavelength)
    }
}

noise_methods!(Value);
tileable!(Value);
