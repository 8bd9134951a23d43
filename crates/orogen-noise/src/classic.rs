//! Perlin's noise with the permutation table of his 2002 reference.

use crate::builder::noise_builder;
use crate::choices::ClassicVariant;
use crate::methods::noise_methods;
use crate::prepared::preparable;
use crate::program::{Program, Source};
use crate::tiled::tileable;

/// Perlin's improved noise as published. Its table has 256 entries, so it repeats every 256 cells.
///
/// It exists for comparison with textbooks: with seed 0 and wavelength 1, its three-dimensional methods return
/// `ImprovedNoise.noise(x, y, z)` of the reference. [`crate::Perlin`] has better quality and is faster. The table has
/// no seed. Other seeds displace the lattice by whole cells, so two seeds give two parts of the same noise.
///
/// Range: -1 ..= 1 in 2D, within 1.03635 in 3D, within 1.53658 in 4D. Zero at every lattice point. Its gradient is
/// exact.
///
/// K. Perlin, "Improving noise", SIGGRAPH 2002; reference code at <https://mrl.cs.nyu.edu/~perlin/noise/>.
///
/// ```
/// let noise = orogen_noise::Classic::default();
/// assert!((noise.sample3(3.14, 42.0, 7.0) - 0.13691995878400012).abs() < 1e-6);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Classic {
    /// Seed. 0 is the published noise; other values displace it. Default 0.
    pub seed: u64,
    /// Distance between lattice points, in metres. Default 1.
    pub wavelength: f64,
    /// The gradients in 2D. Default [`ClassicVariant::Diagonal`].
    pub variant: ClassicVariant,
}

impl Default for Classic {
    fn default() -> Classic {
        Classic { seed: 0, wavelength: 1.0, variant: ClassicVariant::Diagonal }
    }
}

noise_builder!(Classic: with_variant(variant: ClassicVariant));

impl Classic {
    pub(crate) fn program(&self, _: usize) -> Program {
        Program::single(Source::Classic(self.variant), self.seed, self.wavelength)
    }
}

noise_methods!(Classic);
preparable!(Classic);
tileable!(Classic);
