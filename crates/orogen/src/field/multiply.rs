//! Product of two.

use crate::op::{Field, Inputs, WorldParams};
use orogen_noise::Points;

op! {
    /// a * b: scales one by the other.
    pub struct Multiply = "multiply", field, revision 1;
    inputs {
        /// One.
        a: required,
        /// The other.
        b: required,
    }
}

impl Field for Multiply {
    fn eval(&self, _: &Points, inputs: &Inputs, _: &WorldParams, out: &mut [f32]) {
        for ((sample, a), b) in out.iter_mut().zip(inputs.required(0)).zip(inputs.required(1)) {
            *sample = a * b;
        }
    }
}
