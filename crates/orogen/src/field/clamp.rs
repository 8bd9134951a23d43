//! Cutting values off.

use crate::op::{Field, Inputs, WorldParams};
use orogen_noise::Points;

op! {
    /// The source, cut off below `low` and above `high`.
    pub struct Clamp = "clamp", field, revision 1;
    inputs {
        /// What is cut.
        source: required,
    }
    params {
        /// Lowest value left, in the source's unit.
        low: f64 = 0.0, range -1e9 to 1e9;
        /// Highest value left, in the source's unit.
        high: f64 = 1.0, range -1e9 to 1e9;
    }
    check |op| match op.low <= op.high {
        true => Ok(()),
        false => Err(("low", format!("`low` ({}) must not be above `high` ({})", op.low, op.high))),
    };
}

impl Field for Clamp {
    fn eval(&self, _: &Points, inputs: &Inputs, _: &WorldParams, out: &mut [f32]) {
        let (low, high) = (self.low as f32, self.high as f32);
        for (sample, source) in out.iter_mut().zip(inputs.required(0)) {
            *sample = source.clamp(low, high);
        }
    }
}
