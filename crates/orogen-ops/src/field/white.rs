//! White noise.

use super::basis::{lower, sample};
use crate::lower::Lowering;
use crate::op::{Field, Inputs, WorldParams};
use orogen_noise::Points;
use orogen_noise::shader::function::Shader;

op! {
    /// White noise: an independent value in -1 ..= 1 for each square of side `wavelength`.
    pub struct White = "white", field, revision 1;
    space;
    params {
        /// Seed of the node, hashed with the world's seed. Two nodes with equal seeds make the same noise.
        seed: u64 = 0;
        /// Side of a square.
        wavelength: f64 = 10.0, unit "m", range 1e-3 to 1e9, alias "scale";
    }
}

impl White {
    fn noise(&self, world_params: &WorldParams) -> orogen_noise::White {
        orogen_noise::White::new(world_params.seed_of(self.seed), self.wavelength)
    }
}

impl Field for White {
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
