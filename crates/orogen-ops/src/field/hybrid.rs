//! Musgrave's hybrid multifractal.

use super::basis::{cost, lower, sample};
use crate::lower::Lowering;
use crate::op::{Field, Inputs, WorldParams};
use orogen_noise::shader::function::Shader;
use orogen_noise::{Fractal, Kind, Points};

op! {
    /// Hybrid multifractal: each octave is scaled by the product of those before it, so valleys stay smooth and high
    /// ground is rough. In -1 ..= 1.
    ///
    /// s_i = gain^i (n_i + offset); height += w s_i; w = clamp(w s_i, 0, 1), starting at 1. The result is divided by
    /// the largest possible sum, which is rarely approached: use `normalise` or `remap` after it. Musgrave in Ebert et
    /// al., "Texturing and Modeling" (1994).
    pub struct Hybrid = "hybrid", field, revision 1;
    octaves in space;
    params {
        /// Value added to the noise. With 0.7 lowlands are plains; with higher values detail is everywhere.
        offset: f64 = 0.7, range -4.0 to 4.0;
    }
}

impl Hybrid {
    fn noise(&self, world_params: &WorldParams) -> Fractal {
        self.fractal(world_params, Kind::Hybrid { offset: self.offset })
    }
}

impl Field for Hybrid {
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
