//! Perlin's gradient noise over a hashed lattice.

use crate::methods::noise_methods;
use crate::program::{Program, Source};
use crate::tiled::tileable;

/// Perlin's improved gradient noise, with gradients hashed from 64-bit cells instead of looked up in a table of 256: it never
/// repeats, and every seed is a noise of its own.
///
/// Gradients have one length. In 2D there are 16 directions, 11.25 + 22.5 k degrees, so that none lies along an axis or a
/// diagonal; in 3D there are 32, the corners and face centres of an icosahedron. The result is scaled so that its true
/// maximum is 1: the raw noise reaches .695353 in 2D, at (.5, .5266) in a cell, and sqrt(3/4) in 3D, in a cell's middle.
///
/// Range: within [-1, 1]. Zero mean; zero at every lattice point. Its gradient is exact.
///
/// K. Perlin, "Improving noise", SIGGRAPH 2002.
///
/// ```
/// let noise = orogen_noise::Perlin { seed: 7, wavelength: 100.0 };
/// assert_eq!(noise.sample(200.0, -300.0), 0.0);
/// assert!(noise.sample(250.0, -250.0).abs() <= 1.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Perlin {
    /// Any number; neighbouring seeds give unrelated noise. Default 0.
    pub seed: u64,
    /// Distance between lattice points, metres. Default 1.
    pub wavelength: f64,
}

impl Default for Perlin {
    fn default() -> Perlin {
        Perlin { seed: 0, wavelength: 1.0 }
    }
}

impl Perlin {
    pub(crate) fn program(&self, _: usize) -> Program {
        Program::single(Source::Perlin, self.seed, self.wavelength)
    }
}

noise_methods!(Perlin);
tileable!(Perlin);
