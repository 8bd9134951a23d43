//! Ridged fractal noise.

use super::basis::{cost, sample};
use crate::op::{Field, Inputs, WorldParams};
use orogen_noise::{Kind, Points};

op! {
    /// Ridged noise: the sum of octaves of 1 - 2 |noise|, in -1 ..= 1. It gives sharp crests and round valleys. Musgrave 1994.
    pub struct Ridged = "ridged", field, revision 1;
    octaves in space;
}

impl Field for Ridged {
    fn eval(&self, at: &Points, inputs: &Inputs, world_params: &WorldParams, out: &mut [f32]) {
        let noise = self.fractal(world_params, Kind::Ridged);
        sample(&noise, at, self.depth(inputs), out);
    }

    fn cost(&self) -> f64 {
        cost(self.basis).octaves(self.octaves).anywhere
    }

    fn cost_in_rows(&self) -> f64 {
        cost(self.basis).octaves(self.octaves).in_rows
    }
}
