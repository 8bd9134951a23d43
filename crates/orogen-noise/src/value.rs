//! Value noise.

use crate::builder::noise_builder;
use crate::choices::Fade;
use crate::methods::noise_methods;
use crate::prepared::preparable;
use crate::program::{Program, Source};
use crate::tiled::tileable;

/// Value noise: random values on a square lattice, interpolated.
///
/// Range: -1 ..= 1. Zero mean. Its gradient is exact (with [`Fade::Linear`] except on the lattice lines). It is faster
/// than [`crate::Perlin`], but its lattice is more visible.
///
/// ```
/// let noise = orogen_noise::Value::new(7, 100.0);
/// assert!(noise.sample(12.5, -3.0).abs() <= 1.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Value {
    /// Any number; neighboring seeds give unrelated noise. Default 0.
    pub seed: u64,
    /// Distance between lattice points, in metres. Default 1.
    pub wavelength: f64,
    /// The interpolation. Default [`Fade::Quintic`].
    pub fade: Fade,
}

impl Default for Value {
    fn default() -> Value {
        Value { seed: 0, wavelength: 1.0, fade: Fade::Quintic }
    }
}

noise_builder!(Value: with_fade(fade: Fade));

impl Value {
    pub(crate) fn program(&self, _: usize) -> Program {
        Program::single(Source::Value(self.fade), self.seed, self.wavelength)
    }
}

noise_methods!(Value);
preparable!(Value);
tileable!(Value);
