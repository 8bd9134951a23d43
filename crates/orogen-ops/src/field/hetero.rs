//! Musgrave's heterogeneous terrain.

use super::basis::{cost, lower, sample};
use crate::lower::Lowering;
use crate::op::{Field, Inputs, WorldParams};
use orogen_noise::shader::function::Shader;
use orogen_noise::{Fractal, Kind, Points};

op! {
    /// Heterogeneous terrain: each octave is scaled by the height so far, so low ground is smooth and high ground is
    /// rough. In -1 ..= 1.
    ///
    /// h = n_0 + offset; h += h gain^i (n_i + offset). The result is divided by the largest possible product, which is
    /// rarely approached: use `normalise` or `remap` after it. Musgrave in Ebert et al., "Texturing and Modeling"
    /// (1994).
    pub struct Hetero = "hetero", field, revision 1;
    octaves in space;
    params {
        /// Value added to the noise. Ground is smooth where the sum of both is small.
        offset: f64 = 0.7, range -4.0 to 4.0;
    }
}

impl Hetero {
    fn noise(&self, world_params: &WorldParams) -> Fractal {
        self.fractal(world_params, Kind::Hetero { offset: self.offset })
    }
}

impl Field for Hetero {
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
