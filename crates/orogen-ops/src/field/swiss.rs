//! Swiss turbulence.

use super::basis::{cost, lower, sample};
use crate::lower::Lowering;
use crate::op::{Field, Inputs, WorldParams};
use orogen_noise::shader::function::Shader;
use orogen_noise::{Fractal, Kind, Points};

op! {
    /// Swiss turbulence: ridged noise whose slopes displace the finer octaves, so that crests branch into spurs. In -1
    /// ..= 1.
    ///
    /// n_i at p + warp d; height += a_i (1 - |n_i|); d -= a_i n_i grad n_i; a_i+1 = a_i gain clamp(height, 0, 1). Over
    /// `white` and the `worley` bases, which have no slope, nothing is displaced. De Carpentier, "Scape: procedural
    /// basics" (2011).
    pub struct Swiss = "swiss", field, revision 1;
    octaves in space;
    params {
        /// How far slopes displace the later octaves, in wavelengths of the first octave: 0 is none, 0.15 is typical.
        warp: f64 = 0.15, range -4.0 to 4.0;
    }
}

impl Swiss {
    fn noise(&self, world_params: &WorldParams) -> Fractal {
        self.fractal(world_params, Kind::Swiss { warp: self.warp })
    }
}

impl Field for Swiss {
    fn eval(&self, at: &Points, inputs: &Inputs, world_params: &WorldParams, out: &mut [f32]) {
        sample(&self.noise(world_params), at, self.depth(inputs), out);
    }

    fn lower(&self, _: usize, world_params: &WorldParams) -> Lowering<Shader> {
        lower(&self.noise(world_params), self.vertical)
    }

    fn cost(&self) -> f64 {
        cost(self.basis).moved().octaves(self.octaves).anywhere
    }

    fn cost_in_rows(&self) -> f64 {
        cost(self.basis).moved().octaves(self.octaves).in_rows
    }
}
