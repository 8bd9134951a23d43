//! OpenSimplex2 noise.

use orogen_noise::Basis;

choice! {
    /// Variant of OpenSimplex2.
    pub enum Smoothness as orogen_noise::Smoothness {
        /// The smallest number of lattice points per sample.
        Fast = "fast",
        /// More lattice points per sample with wider, rounder kernels: softer noise.
        Smooth = "smooth",
    }
}

op! {
    /// OpenSimplex2 noise, in -1 ..= 1: Simplex noise with 24 gradient directions, and a smooth variant.
    ///
    /// Lattice, gradients and wide kernels by K. Spencer, with the engine's own hash.
    pub struct OpenSimplex2 = "opensimplex2", field, revision 1;
    params {
        /// Seed of the node, hashed with the world's seed. Two nodes with equal seeds make the same noise.
        seed: u64 = 0;
        /// Side of the squares that are skewed into the triangular lattice.
        wavelength: f64 = 1000.0, unit "m", range 1e-3 to 1e9, alias "scale";
        /// Fast or smooth variant.
        smoothness: Smoothness = Smoothness::Fast;
    }
    noise |op, world_params| {
        orogen_noise::OpenSimplex2::new(world_params.seed_of(op.seed), op.wavelength).with_smoothness(op.smoothness.into())
    };
    cost |op| match op.smoothness {
        Smoothness::Fast => Basis::OpenSimplex2.cost(),
        Smoothness::Smooth => Basis::OpenSimplex2Smooth.cost(),
    };
}
