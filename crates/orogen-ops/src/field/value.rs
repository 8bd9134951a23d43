//! Value noise.

use super::basis::{lower, sample};
use crate::lower::Lowering;
use crate::op::{Field, Inputs, WorldParams};
use orogen_noise::Points;
use orogen_noise::shader::function::Shader;

choice! {
    /// Interpolation between the lattice points of value noise.
    pub enum Fade {
        /// 6 t^5 - 15 t^4 + 10 t^3: continuous first and second derivatives.
        Quintic = "quintic",
        /// 3 t^2 - 2 t^3: continuous first derivative.
        Cubic = "cubic",
        /// t: linear interpolation, with creases along the lattice lines.
        Linear = "linear",
    }
}

impl Fade {
    fn noise(self) -> orogen_noise::Fade {
        match self {
            Fade::Quintic => orogen_noise::Fade::Quintic,
            Fade::Cubic => orogen_noise::Fade::Cubic,
            Fade::Linear => orogen_noise::Fade::Linear,
        }
    }
}

op! {
    /// Value noise: random values in -1 ..= 1 on a square lattice, interpolated between the lattice points.
    pub struct Value = "value", field, revision 1;
    space;
    params {
        /// Seed of the node, hashed with the world's seed. Two nodes with equal seeds make the same noise.
        seed: u64 = 0;
        /// Distance between lattice points.
        wavelength: f64 = 1000.0, unit "m", range 1e-3 to 1e9, alias "scale";
        /// Interpolation between lattice points.
        fade: Fade = Fade::Quintic;
    }
}

impl Value {
    fn noise(&self, world_params: &WorldParams) -> orogen_noise::Value {
        orogen_noise::Value::new(world_params.seed_of(self.seed), self.wavelength).with_fade(self.fade.noise())
    }
}

impl Field for Value {
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
