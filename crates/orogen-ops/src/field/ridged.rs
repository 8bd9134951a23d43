//! Ridged fractal noise.

use super::basis::{cost, lower, sample};
use crate::lower::Lowering;
use crate::op::{Field, Inputs, WorldParams};
use orogen_noise::shader::function::Shader;
use orogen_noise::{Fractal, Kind, Points};

op! {
    /// Ridged noise: the sum of octaves of 1 - 2 |noise|, in -1 ..= 1. It gives sharp crests and round valleys.
    /// Musgrave 1994.
    pub struct Ridged = "ridged", field, revision 1;
    octaves in space;
}

impl Ridged {
    fn noise(&self, world_params: &WorldParams) -> Fractal {
        self.fractal(world_params, Kind::Ridged)
    }
}

impl Field for Ridged {
    fn eval(&self, at: &Points, inputs: &Inputs, world_params: &WorldParams, out: &mut [f32]) {
        sample(&self.noise(world_params), at, self.depth(inputs), out);
    }

    fn lower(&self, _: usize, world_params: &WorldParams) -> Lowering<Shader> {
        lower(&self.noise(world_params), self.vertical)
    }

    fn cost(&self) -> f64 {
        cost(self.basis).octaves(self.octaves).anywhere
    }

    fn cost_in_rows(&self) -> f64 {
        cost(self.basis).octaves(self.octaves).in_rows
    }
}
