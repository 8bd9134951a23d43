//! Simplex noise.

use crate::builder::noise_builder;
use crate::methods::noise_methods;
use crate::prepared::preparable;
use crate::program::{Program, Source};

/// Perlin's Simplex noise: gradients on the corners of triangles (tetrahedra in 3D, simplices in 4D) instead of
/// squares. The gradients are hashed, as in [`crate::Perlin`].
///
/// A sample has three corners in the plane, four in space and five in 4D. Each contributes (1/2 - d^2)^4 g . d at
/// distance d. The kernel ends at the next simplex in 3D and 4D, too, so the noise is continuous; the usual radius of
/// .6 causes discontinuities. Simplex noise has fewer axis-aligned features than Perlin noise. Its features are about
/// .7 times as wide at the same wavelength.
///
/// Range: -1 ..= 1, with maxima of 1 in all dimensions. Zero mean; zero at every corner. Its gradient is exact. It
/// cannot repeat along the axes.
///
/// K. Perlin, "Noise hardware", SIGGRAPH course (2001); S. Gustavson, "Simplex noise demystified" (2005).
///
/// ```
/// let noise = orogen_noise::Simplex::new(7, 100.0);
/// assert!(noise.sample(250.0, -250.0).abs() <= 1.0);
/// assert_eq!(noise.sample(0.0, 0.0), 0.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Simplex {
    /// Any number; neighboring seeds give unrelated noise. Default 0.
    pub seed: u64,
    /// Side of the squares from which the triangles are skewed, in metres. Default 1.
    pub wavelength: f64,
}

impl Default for Simplex {
    fn default() -> Simplex {
        Simplex { seed: 0, wavelength: 1.0 }
    }
}

noise_builder!(Simplex);

impl Simplex {
    pub(crate) fn program(&self, _: usize) -> Program {
        Program::single(Source::Simplex, self.seed, self.wavelength)
    }
}

noise_methods!(Simplex);
preparable!(Simplex);
