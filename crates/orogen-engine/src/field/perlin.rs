//! Perlin noise.

use super::basis::sample;
use crate::op::{Field, Inputs, WorldParams};
use orogen_noise::Points;

op! {
    /// Perlin's gradient noise (2002) on a hashed lattice, in -1 ..= 1. It is smooth and has no period.
    pub struct Perlin = "perlin", field, revision 1;
    space;
    params {
        /// Seed of the node, hashed with the world's seed. Two nodes with equal seeds make the same noise.
        seed: u64 = 0;
        /// Distance between lattice points, which is about the distance between hills.
        wavelength: f64 = 1000.0, unit "m", range 1e-3 to 1e9;
    }
}

impl Field for Perlin {
    fn eval(&self, at: &Points, inputs: &Inputs, world_params: &WorldParams, out: &mut [f32]) {
        let noise = orogen_noise::Perlin::new(world_params.seed_of(self.seed), self.wavelength);
        sample(&noise, at, self.depth(inputs), out);
    }

    fn cost(&self) -> f64 {
        1.0
    }
}
