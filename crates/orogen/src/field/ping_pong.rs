//! Folded fractal noise.

use super::basis::{cost, fill};
use crate::op::{Field, Inputs, WorldParams};
use orogen_noise::{Kind, Points};

op! {
    /// Ping-pong: octaves of noise folded to and fro and summed, in -1 ..= 1. Contour bands, like those of agate or terraced rice.
    ///
    /// t = strength (n_i + 1) runs up to 1 and down to 0 and up again: the sum of gain^i times twice that less 1, divided by the sum of
    /// the amplitudes.
    pub struct PingPong = "ping-pong", field, revision 1;
    octaves;
    params {
        /// How often the range of the noise is folded, 2 strength - 1 times: 0.5 is plain fbm, 1 is `ridged`, 2 usual, 4 many bands.
        strength: f64 = 2.0, range 0.5 to 64.0;
    }
}

impl Field for PingPong {
    fn eval(&self, at: &Points, _: &Inputs, world_params: &WorldParams, out: &mut [f32]) {
        let noise = self.fractal(world_params, Kind::PingPong { strength: self.strength });
        fill(out, |out| noise.fill(at, out));
    }

    fn cost(&self) -> f64 {
        cost(self.basis).octaves(self.octaves).anywhere
    }

    fn cost_in_rows(&self) -> f64 {
        cost(self.basis).octaves(self.octaves).in_rows
    }
}
