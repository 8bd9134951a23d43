//! Simplex noise.

use crate::methods::noise_methods;
use crate::program::{Program, Source};

/// Perlin's Simplex noise: gradients on the corners of triangles (in 3D tetrahedra, in 4D their like) instead of squares, with hashed
/// gradients like those of [`crate::Perlin`].
///
/// A sample has three corners in the plane, four in space and five in 4D, each contributing (1/2 - d^2)^4 g . d at distance d. In space,
/// too, the kernel ends where the next tetrahedron begins, so there are no breaks (the usual .6 has them). Fewer straight lines
/// than Perlin noise; features are about .7 times as wide at the same wavelength.
///
/// Range: within [-1, 1]; the true maxima are 1 in all dimensions. Zero mean; zero at every corner. Its gradient is exact. It
/// cannot repeat along the axes.
///
/// K. Perlin, "Noise hardware", SIGGRAPH course (2001); S. Gustavson, "Simplex noise demystified" (2005).
///
/// ```
/// let noise = orogen_noise::Simplex { seed: 7, wavelength: 100.0 };
/// assert!(noise.sample(250.0, -250.0).abs() <= 1.0);
/// assert_eq!(noise.sample(0.0, 0.0), 0.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Simplex {
    /// Any number; neighbouring seeds give unrelated noise. Default 0.
    pub seed: u64,
    /// Side of the squares that the triangles are skewed from, metres. Default 1.
    pub wavelength: f64,
}

impl Default for Simplex {
    fn default() -> Simplex {
        Simplex { seed: 0, wavelength: 1.0 }
    }
}

impl Simplex {
    pub(crate) fn program(&self, _: usize) -> Program {
        Program::single(Source::Simplex, self.seed, self.wavelength)
    }
}

noise_methods!(Simplex);
