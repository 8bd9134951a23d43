//! Simplex noise.

use super::basis::{cost, lower, sample};
use crate::lower::Lowering;
use crate::op::{Field, Inputs, WorldParams};
use orogen_noise::shader::function::Shader;
use orogen_noise::{Basis, Points};

op! {
    /// Perlin's Simplex noise (2001), in -1 ..= 1: gradients at the corners of a triangular lattice. It has no
    /// artifacts along the axes.
    ///
    /// Features are about 0.7 times as wide as those of `perlin` at the same wavelength. Gustavson, "Simplex noise
    /// demystified" (2005).
    pub struct Simplex = "simplex", field, revision 1;
    space;
    params {
        /// Seed of the node, hashed with the world's seed. Two nodes with equal seeds make the same noise.
        seed: u64 = 0;
        /// Side of the squares that are skewed into the triangular lattice.
        wavelength: f64 = 1000.0, unit "m", range 1e-3 to 1e9, alias "scale";
    }
}

impl Simplex {
    fn noise(&self, world_params: &WorldParams) -> orogen_noise::Simplex {
        orogen_noise::Simplex::new(world_params.seed_of(self.seed), self.wavelength)
    }
}

impl Field for Simplex {
    fn eval(&self, at: &Points, inputs: &Inputs, world_params: &WorldParams, out: &mut [f32]) {
        sample(&self.noise(world_params), at, self.depth(inputs), out);
    }

    fn lower(&self, _: usize, world_params: &WorldParams) -> Lowering<Shader> {
        lower(&self.noise(world_params), self.vertical)
    }

    fn cost(&self) -> f64 {
        cost(Basis::Simplex).anywhere
    }

    fn cost_in_rows(&self) -> f64 {
        cost(Basis::Simplex).in_rows
    }
}
