//! Gradient-weighted fractal noise.

use super::basis::{cost, lower, sample};
use crate::lower::Lowering;
use crate::op::{Field, Inputs, WorldParams};
use orogen_noise::shader::function::Shader;
use orogen_noise::{Fractal, Kind, Points};

choice! {
    /// How slope damps an octave of weighted fBm. m is the squared slope of the octaves so far (dimensionless).
    pub enum Falloff {
        /// 1 / (1 + k m).
        Reciprocal = "reciprocal",
        /// e^(-k m).
        Exponential = "exponential",
        /// 1 / (1 + k sqrt m).
        SquareRoot = "square-root",
        /// 1 - smoothstep(k m): 0 beyond k m = 1.
        Smoothstep = "smoothstep",
    }
}

impl Falloff {
    fn noise(self) -> orogen_noise::Falloff {
        match self {
            Falloff::Reciprocal => orogen_noise::Falloff::Reciprocal,
            Falloff::Exponential => orogen_noise::Falloff::Exponential,
            Falloff::SquareRoot => orogen_noise::Falloff::SquareRoot,
            Falloff::Smoothstep => orogen_noise::Falloff::Smoothstep,
        }
    }
}

op! {
    /// Weighted fBm: octaves of noise, each damped by the slope of the octaves before it. Steep ground stays smooth;
    /// detail concentrates on flats and crests. In -1 ..= 1.
    ///
    /// d += (gain lacunarity)^i grad n_i; height += gain^i n_i falloff(k |d|^2), divided by the sum of the amplitudes.
    /// Quilez, "Value noise derivatives" (2008).
    pub struct WeightedFbm = "weighted-fbm", field, revision 1;
    octaves in space;
    params {
        /// How strongly slope damps later octaves: 0 gives plain fBm, 1 is typical, 10 leaves bare pyramids.
        k: f64 = 1.0, range 0.0 to 1e6;
        /// Damping function, with m the squared slope.
        falloff: Falloff = Falloff::Reciprocal;
    }
}

impl WeightedFbm {
    fn noise(&self, world_params: &WorldParams) -> Fractal {
        self.fractal(world_params, Kind::Weighted { k: self.k, falloff: self.falloff.noise() })
    }
}

impl Field for WeightedFbm {
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
