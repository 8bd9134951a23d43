//! Folded fractal noise.

use super::basis::{cost, lower, sample};
use crate::lower::Lowering;
use crate::op::{Field, Inputs, WorldParams};
use orogen_noise::shader::function::Shader;
use orogen_noise::{Fractal, Kind, Points};

op! {
    /// Ping-pong noise: a sum of octaves of folded noise, in -1 ..= 1. It gives contour bands like those of agate or of
    /// rice terraces.
    ///
    /// t = strength (n_i + 1) is folded into 0 ..= 1 as a triangle wave. The result is the sum of gain^i (2 t - 1),
    /// divided by the sum of the amplitudes.
    pub struct PingPong = "ping-pong", field, revision 1;
    octaves in space;
    params {
        /// How often the noise's range is folded (2 strength - 1 times): 0.5 gives plain fBm, 1 gives `ridged`, 2 is
        /// typical, 4 gives many bands.
        strength: f64 = 2.0, range 0.5 to 64.0;
    }
}

impl PingPong {
    fn noise(&self, world_params: &WorldParams) -> Fractal {
        self.fractal(world_params, Kind::PingPong { strength: self.strength })
    }
}

impl Field for PingPong {
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
