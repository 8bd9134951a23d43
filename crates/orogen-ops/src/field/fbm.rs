//! Fractional Brownian motion.

use super::basis::{cost, lower, sample};
use crate::lower::Lowering;
use crate::op::{Field, Inputs, WorldParams};
use orogen_noise::shader::function::Shader;
use orogen_noise::{Fractal, Kind, Points};

op! {
    /// Fractional Brownian motion (fBm): a sum of octaves of noise, in -1 ..= 1.
    ///
    /// The sum of gain^i n_i(p lacunarity^i / wavelength), divided by the sum of the amplitudes. Each octave has its
    /// own seed and offset. Mandelbrot and Van Ness 1968; Musgrave 1989.
    pub struct Fbm = "fbm", field, revision 1;
    octaves in space;
}

impl Fbm {
    fn noise(&self, world_params: &WorldParams) -> Fractal {
        self.fractal(world_params, Kind::Fbm)
    }
}

impl Field for Fbm {
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
