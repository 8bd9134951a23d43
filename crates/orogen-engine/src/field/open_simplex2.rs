//! OpenSimplex2 noise.

use super::basis::{cost, sample};
use crate::op::{Field, Inputs, WorldParams};
use orogen_noise::{Basis, Points};

choice! {
    /// Variant of OpenSimplex2.
    pub enum Smoothness {
        /// The smallest number of lattice points per sample.
        Fast = "fast",
        /// More lattice points per sample with wider, rounder kernels: softer noise.
        Smooth = "smooth",
    }
}

impl Smoothness {
    fn basis(self) -> Basis {
        match self {
            Smoothness::Fast => Basis::OpenSimplex2,
            Smoothness::Smooth => Basis::OpenSimplex2Smooth,
        }
    }
}

op! {
    /// OpenSimplex2 noise, in -1 ..= 1: Simplex noise with 24 gradient directions, and a smooth variant.
    ///
    /// Lattice, gradients and wide kernels by K. Spencer, with the engine's own hash.
    pub struct OpenSimplex2 = "opensimplex2", field, revision 1;
    space;
    params {
        /// Seed of the node, hashed with the world's seed. Two nodes with equal seeds make the same noise.
        seed: u64 = 0;
        /// Side of the squares that are skewed into the triangular lattice.
        wavelength: f64 = 1000.0, unit "m", range 1e-3 to 1e9;
        /// Fast or smooth variant.
        smoothness: Smoothness = Smoothness::Fast;
    }
}

impl Field for OpenSimplex2 {
    fn eval(&self, at: &Points, inputs: &Inputs, world_params: &WorldParams, out: &mut [f32]) {
        let noise = orogen_noise::OpenSimplex2::new(world_params.seed_of(self.seed), self.wavelength).with_smoothness(
            match self.smoothness {
                Smoothness::Fast => orogen_noise::Smoothness::Fast,
                Smoothness::Smooth => orogen_noise::Smoothness::Smooth,
            },
        );
        sample(&noise, at, self.depth(inputs), out);
    }

    fn cost(&self) -> f64 {
        cost(self.smoothness.basis()).anywhere
    }

    fn cost_in_rows(&self) -> f64 {
        cost(self.smoothness.basis()).in_rows
    }
}
