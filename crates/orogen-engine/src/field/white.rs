//! White noise.

use super::basis::sample;
use crate::op::{Field, Inputs, WorldParams};
use orogen_noise::Points;

op! {
    /// White noise: an independent value in -1 ..= 1 for each square of side `wavelength`.
    pub struct White = "white", field, revision 1;
    space;
    params {
        /// Seed of the node, hashed with the world's seed. Two nodes with equal seeds make the same noise.
        seed: u64 = 0;
        /// Side of a square.
        wavelength: f64 = 10.0, unit "m", range 1e-3 to 1e9;
    }
}

impl Field for White {
    fn eval(&self, at: &Points, inputs: &Inputs, world_params: &WorldParams, out: &mut [f32]) {
        let noise = orogen_noise::White::new(world_params.seed_of(self.seed), self.wavelength);
        sample(&noise, at, self.depth(inputs), out);
    }

    fn cost(&self) -> f64 {
        1.0
    }
}
