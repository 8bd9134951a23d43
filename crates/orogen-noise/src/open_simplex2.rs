//! OpenSimplex2 noise.

use crate::choices::Smoothness;
use crate::methods::noise_methods;
use crate::program::{Program, Source};

/// OpenSimplex2: Simplex noise with more gradients (24 directions in the plane, 48 in space), in space turned so that planes of
/// constant z look their best, and a smooth variant with wider kernels.
///
/// | kernel r^2 | 2D | 3D | 4D |
/// |---|---|---|---|
/// | fast | 1/2 | 1/2 | 1/2 |
/// | smooth | 2/3 | 3/4 | 4/5 |
///
/// The lattices, gradients and wide kernels are those of K. Spencer's OpenSimplex2; the hash is ours, and the fast kernels in 3D and 4D
/// end at 1/2 instead of .6, where no corner is missed. In 4D the gradients are the 32 of [`crate::Perlin`], and the smooth variant looks
/// at every corner in reach: it is thorough rather than quick.
///
/// Range: within [-1, 1]; the true maxima are 1. Zero mean. Its gradient is exact. It cannot repeat along the axes.
///
/// ```
/// use orogen_noise::{OpenSimplex2, Smoothness};
///
/// let noise = OpenSimplex2 { wavelength: 100.0, smoothness: Smoothness::Smooth, ..Default::default() };
/// assert!(noise.sample3(250.0, -250.0, 40.0).abs() <= 1.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpenSimplex2 {
    /// Any number; neighbouring seeds give unrelated noise. Default 0.
    pub seed: u64,
    /// Side of the squares that the triangles are skewed from, metres. Default 1.
    pub wavelength: f64,
    /// How far corners reach. Default [`Smoothness::Fast`].
    pub smoothness: Smoothness,
}

impl Default for OpenSimplex2 {
    fn default() -> OpenSimplex2 {
        OpenSimplex2 { seed: 0, wavelength: 1.0, smoothness: Smoothness::Fast }
    }
}

impl OpenSimplex2 {
    pub(crate) fn program(&self, _: usize) -> Program {
        Program::single(Source::OpenSimplex2(self.smoothness), self.seed, self.wavelength)
    }
}

noise_methods!(OpenSimplex2);
