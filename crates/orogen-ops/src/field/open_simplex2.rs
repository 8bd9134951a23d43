//! OpenSimplex2 noise.

use super::basis::{cost, lower, sample};
use crate::lower::Lowering;
use crate::op::{Field, Inputs, WorldParams};
use orogen_noise::shader::function::Shader;
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
        wavelength: f64 = 1000.0, unit "m", range 1e-3 to 1e9, alias "scale";
        /// Fast or smooth variant.
        smoothness: Smoothness = Smoothness::Fast;
    }
}

impl OpenSimplex2 {
    fn noise(&self, world_params: &WorldParams) -> orogen_noise::OpenSimplex2 {
        orogen_noise::OpenSimplex2::new(world_params.seed_of(self.seed), self.wavelength).with_smoothness(
            match self.smoothness {
                Smoothness::Fast => orogen_noise::Smoothness::Fast,
                Smoothness::Smooth => orogen_noise::Smoothness::Smooth,
            },
        )
    }
}

impl Field for OpenSimplex2 {
    fn eval(&self, at: &Points, inputs: &Inputs, world_params: &WorldParams, out: &mut [f32]) {
        sample(&self.noise(world_params), at, self.depth(inputs), out);
    }

    fn lower(&self, _: usize, world_params: &WorldParams) -> Lowering<Shader> {
        lower(&self.noise(world_params), self.vertical)
    }

    fn cost(&self) -> f64 {
        cost(self.smoothness.basis()).anywhere
    }

    fn cost_in_rows(&self) -> f64 {
        cost(self.smoothness.basis()).in_rows
    }
}
