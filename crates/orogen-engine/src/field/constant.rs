//! A constant value.

use crate::op::{Field, Inputs, WorldParams};
use orogen_noise::Points;

op! {
    /// The same value everywhere.
    pub struct Constant = "constant", field, revision 1;
    params {
        /// The value, in the unit that the nodes reading it expect.
        value: f64 = 0.0, range -1e9 to 1e9;
    }
}

impl Field for Constant {
    fn eval(&self, _: &Points, _: &Inputs, _: &WorldParams, out: &mut [f32]) {
        out.fill(self.value as f32);
    }
}
