//! The texture of an example, such as the heights of a real place, over a plane without bounds.
//!
//! Random patches of the example are blended on a lattice of triangles, and the blend keeps the histogram of the
//! example: E. Heitz and F. Neyret, "High-performance by-example noise using a histogram-preserving blending operator"
//! (Proceedings of the ACM on Computer Graphics and Interactive Techniques 1(2), 2018), with the histogram of one value
//! as by T. Deliot and E. Heitz, "Procedural stochastic textures by tiling and blending" (GPU Zen 2, 2019). Weights are
//! smooth bumps in place of barycentric coordinates, so that slopes have no steps at the sides of triangles.

mod normal;
mod patches;
mod trend;

pub use patches::Sampler;

use crate::grid::Grid;
use normal::{InverseTable, gaussianized};

/// How an example becomes a texture.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Exemplar {
    /// Distance between the samples of the example in the world, in metres; 0 for the example's own.
    pub cell: f64,
    /// Diameter of the patches, in metres of the world; 0 for half of the example's shorter side.
    pub patch: f64,
    /// Wavelength in metres of the world above which the example is a trend that is taken out; `None` to keep it.
    pub wavelength: Option<f64>,
    /// Whether patches are turned by quarter turns and mirrored.
    pub rotate: bool,
}

impl Default for Exemplar {
    /// The defaults of the op `exemplar`.
    fn default() -> Exemplar {
        Exemplar { cell: 0.0, patch: 0.0, wavelength: None, rotate: false }
    }
}

orogen_noise::builder!(
    Exemplar:
    with_cell(cell: f64),
    with_patch(patch: f64),
    with_wavelength(wavelength: Option<f64>),
    with_rotate(rotate: bool)
);

/// Minimum number of samples along a side of an example.
pub const MIN_SIDE: usize = 16;

/// Maximum diameter of a patch over the shorter side of the example: what is left is the room for random positions.
pub const MAX_PATCH: f64 = 0.75;

/// Minimum diameter of a patch, in samples of the example.
pub const MIN_PATCH: f64 = 8.0;

/// Samples around a patch that are kept inside the example: for interpolation, and for the rounding of its middle.
const BORDER: usize = 3;

/// An example prepared for sampling.
#[derive(Debug, Clone)]
pub struct Texture {
    /// The example with a normal distribution, less its mean, in rows.
    samples: Vec<f32>,
    width: usize,
    height: usize,
    /// Distance between samples, in metres.
    cell: f64,
    /// Radius of a patch, in samples.
    radius: f64,
    rotate: bool,
    /// Mean of the example with a normal distribution: 0 if no two samples are equal.
    mean: f32,
    inverse: InverseTable,
}

impl Exemplar {
    /// Distance between the samples of an example in the world, in metres.
    #[must_use]
    pub fn cell_of(&self, example: &Grid) -> f64 {
        if self.cell > 0.0 { self.cell } else { example.window().cell }
    }

    /// Diameter of the patches of an example with this shorter side, in samples.
    #[must_use]
    pub fn patch_of(&self, cell: f64, side: usize) -> f64 {
        if self.patch > 0.0 { self.patch / cell } else { 0.5 * side as f64 }
    }

    /// Maximum diameter of the patches of an example with this shorter side, in samples.
    #[must_use]
    pub fn max_patch(side: usize) -> f64 {
        (MAX_PATCH * side as f64).min(side as f64 - (2 * BORDER + 2) as f64)
    }

    /// The texture of an example without missing samples. `None` if it has fewer than [`MIN_SIDE`] samples along a
    /// side. Patches larger than [`Exemplar::max_patch`] are made smaller.
    #[must_use]
    pub fn prepare(&self, example: &Grid) -> Option<Texture> {
        let (width, height) = (example.width(), example.height());
        let side = width.min(height);
        if side < MIN_SIDE {
            return None;
        }
        let cell = self.cell_of(example);
        let mut samples = example.data().to_vec();
        if let Some(wavelength) = self.wavelength {
            trend::remove(&mut samples, width, wavelength / cell);
        }
        let (mean, inverse) = gaussianized(&mut samples);
        let patch = self.patch_of(cell, side).clamp(MIN_PATCH, Exemplar::max_patch(side));
        Some(Texture { samples, width, height, cell, radius: 0.5 * patch, rotate: self.rotate, mean, inverse })
    }
}

impl Texture {
    /// Memory of the texture of an example of this many samples, in bytes, while it is prepared.
    #[must_use]
    pub fn memory(samples: usize) -> u64 {
        // A value, and a pair of a value and its index that is sorted.
        12 * samples as u64
    }

    /// A sampler of the texture with a seed.
    #[must_use]
    pub fn sampler(&self, seed: u64) -> Sampler<'_> {
        Sampler::new(self, seed)
    }
}

#[cfg(test)]
mod tests;
