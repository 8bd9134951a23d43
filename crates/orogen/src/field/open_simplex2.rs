//! OpenSimplex2 noise.

use super::basis::{cost, fill};
use crate::op::{Field, Inputs, WorldParams};
use orogen_noise::{Basis, Points};

choice! {
    /// How far the corners of OpenSimplex2 reach.
    pub enum Smoothness {
        /// As few corners to a sample as there can be.
        Fast = "fast",
        /// Wider, rounder kernels and more of them: softer noise.
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
    /// OpenSimplex2 noise, in -1 ..= 1: Simplex noise with more directions, 24 in the plane, and a smooth variant.
    ///
    /// K. Spencer's lattice, gradients and wide kernels, over our own hash.
    pub struct OpenSimplex2 = "opensimplex2", field, revision 1;
    params {
        /// Seed of its own, hashed with the world's: two nodes of one seed are the same noise.
        seed: u64 = 0;
        /// Side of the squares that the triangles are skewed from.
        wavelength: f64 = 1000.0, unit "m", range 1e-3 to 1e9;
        /// How far corners reach.
        smoothness: Smoothness = Smoothness::Fast;
    }
}

impl Field for OpenSimplex2 {
    fn eval(&self, at: &Points, _: &Inputs, world_params: &WorldParams, out: &mut [f32]) {
        let noise = orogen_noise::OpenSimplex2 {
            seed: world_params.seed_of(self.seed),
            wavelength: self.wavelength,
            smoothness: match self.smoothness {
                Smoothness::Fast => orogen_noise::Smoothness::Fast,
                Smoothness::Smooth => orogen_noise::Smoothness::Smooth,
            },
        };
        fill(out, |out| noise.fill(at, out));
    }

    fn cost(&self) -> f64 {
        cost(self.smoothness.basis()).anywhere
    }

    fn cost_in_rows(&self) -> f64 {
        cost(self.smoothness.basis()).in_rows
    }
}
