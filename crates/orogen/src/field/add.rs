//! Sum of two.

use crate::op::{Field, Inputs, WorldParams};
use orogen_noise::Points;

op! {
    /// a + b, in the unit the two share.
    pub struct Add = "add", field, revision 1;
    inputs {
        /// One.
        a: required,
        /// The other.
        b: required,
    }
}

impl Field for Add {
    fn eval(&self, _: &Points, inputs: &Inputs, _: &WorldParams, out: &mut [f32]) {
        for ((sample, a), b) in out.iter_mut().zip(inputs.required(0)).zip(inputs.required(1)) {
            *sample = a + b;
        }
    }
}
