//! The same number everywhere.

use crate::op::{Field, Inputs, WorldParams};
use orogen_noise::Points;

op! {
    /// The same number everywhere.
    pub struct Constant = "constant", field, revision 1;
    params {
        /// The number, in whatever unit its readers take it for.
        value: f64 = 0.0, range -1e9 to 1e9;
    }
}

impl Field for Constant {
    fn eval(&self, _: &Points, _: &Inputs, _: &WorldParams, out: &mut [f32]) {
        out.fill(self.value as f32);
    }
}
