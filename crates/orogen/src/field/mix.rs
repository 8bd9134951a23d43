//! From one to another.

use crate::op::{Field, Inputs, WorldParams};
use orogen_noise::Points;

op! {
    /// a where `amount` is 0, b where it is 1, and in between in proportion: a + (b - a) * amount.
    ///
    /// The amount is cut to 0 ..= 1.
    pub struct Mix = "mix", field, revision 1;
    inputs {
        /// Shows where the amount is 0.
        a: required,
        /// Shows where the amount is 1.
        b: required,
        /// How much of b.
        amount: required,
    }
}

impl Field for Mix {
    fn eval(&self, _: &Points, inputs: &Inputs, _: &WorldParams, out: &mut [f32]) {
        let (a, b, amount) = (inputs.required(0), inputs.required(1), inputs.required(2));
        for (((sample, a), b), amount) in out.iter_mut().zip(a).zip(b).zip(amount) {
            *sample = a + (b - a) * amount.clamp(0.0, 1.0);
        }
    }
}
