//! OpenSimplex2 noise.

use crate::builder::noise_builder;
use crate::choices::Smoothness;
use crate::methods::noise_methods;
use crate::prepared::preparable;
use crate::program::{Program, Source};

/// OpenSimplex2: Simplex noise with more gradients (24 directions in the plane, 48 in space), and a smooth variant with
/// wider kernels. In space it is rotated so that planes of constant z show the least structure.
///
/// | kernel r^2 | 2D | 3D | 4D |
/// |---|---|---|---|
/// | fast | 1/2 | 1/2 | 1/2 |
/// | smooth | 2/3 | 3/4 | 4/5 |
///
/// The lattices, gradients and wide kernels are those of K. Spencer's OpenSimplex2. The hash is different, and the fast
/// kernels in 3D and 4D end at 1/2 instead of .6, so that no corner is missed. In 4D the gradients are the 32
/// directions of [`crate::Perlin`], and the smooth variant evaluates every corner within the radius of the kernel,
/// which is slow.
///
/// Range: -1 ..= 1, with a maximum of 1. Zero mean. Its gradient is exact. It cannot repeat along the axes.
///
/// ```
/// use orogen_noise::{OpenSimplex2, Smoothness};
///
/// let noise = OpenSimplex2::default().with_wavelength(100.0).with_smoothness(Smoothness::Smooth);
/// assert!(noise.sample3(250.0, -250.0, 40.0).abs() <= 1.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct OpenSimplex2 {
    /// Any number; neighboring seeds give unrelated noise. Default 0.
    pub seed: u64,
    /// Side of the squares from which the triangles are skewed, in metres. Default 1.
    pub wavelength: f64,
    /// Size of the kernels. Default [`Smoothness::Fast`].
    pub smoothness: Smoothness,
}

impl Default for OpenSimplex2 {
    fn default() -> OpenSimplex2 {
        OpenSimplex2 { seed: 0, wavelength: 1.0, smoothness: Smoothness::Fast }
    }
}

noise_builder!(OpenSimplex2: with_smoothness(smoothness: Smoothness));

impl OpenSimplex2 {
    pub(crate) fn program(&self, _: usize) -> Program {
        Program::single(Source::OpenSimplex2(self.smoothness), self.seed, self.wavelength)
    }
}

noise_methods!(OpenSimplex2);
preparable!(OpenSimplex2);
