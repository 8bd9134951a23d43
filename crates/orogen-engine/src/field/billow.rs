//! Billowing fractal noise.

use super::basis::{cost, sample};
use crate::op::{Field, Inputs, WorldParams};
use orogen_noise::{Kind, Points};

op! {
    /// Billow noise: the sum of octaves of 2 |noise| - 1, in -1 ..= 1. It gives round hills with sharp valleys between them.
    pub struct Billow = "billow", field, revision 1;
    octaves in space;
}

impl Field for Billow {
    fn eval(&self, at: &Points, inputs: &Inputs, world_params: &WorldParams, out: &mut [f32]) {
        let noise = self.fractal(world_params, Kind::Billow);
        sample(&noise, at, self.depth(inputs), out);
    }

    fn cost(&self) -> f64 {
        cost(self.basis).octaves(self.octaves).anywhere
    }

    fn cost_in_rows(&self) -> f64 {
        cost(self.basis).octaves(self.octaves).in_rows
    }
}
