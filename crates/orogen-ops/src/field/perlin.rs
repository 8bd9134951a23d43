//! Perlin noise.

use super::basis::{lower, sample};
use crate::lower::Lowering;
use crate::op::{Field, Inputs, WorldParams};
use orogen_noise::Points;
use orogen_noise::shader::function::Shader;

op! {
    /// Perlin's gradient noise (2002) on a hashed lattice, in -1 ..= 1. It is smooth and has no period.
    pub struct Perlin = "perlin", field, revision 1;
    space;
    params {
        /// Seed of the node, hashed with the world's seed. Two nodes with equal seeds make the same noise.
        seed: u64 = 0;
        /// Distance between lattice points, which is about the distance between hills.
        wavelength: f64 = 1000.0, unit "m", range 1e-3 to 1e9, alias "scale";
    }
}

impl Perlin {
    fn noise(&self, world_params: &WorldParams) -> orogen_noise::Perlin {
        orogen_noise::Perlin::new(world_params.seed_of(self.seed), self.wavelength)
    }
}

impl Field for Perlin {
    fn eval(&self, at: &Points, inputs: &Inputs, world_params: &WorldParams, out: &mut [f32]) {
        sample(&self.noise(world_params), at, self.depth(inputs), out);
    }

    fn lower(&self, _: usize, world_params: &WorldParams) -> Lowering<Shader> {
        lower(&self.noise(world_params), self.vertical)
    }

    fn cost(&self) -> f64 {
        1.0
    }
}
