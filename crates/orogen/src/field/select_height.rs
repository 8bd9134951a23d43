//! A mask by height.

use crate::analysis::selection::Selection;
use crate::op::{Field, Inputs, WorldParams};
use orogen_noise::Points;

op! {
    /// A mask: 1 where the source lies within a range, falling smoothly to 0 below and above it.
    ///
    /// For heights, or any other values: the layer of a filter or solver, a noise.
    pub struct SelectHeight = "select-height", field, revision 1;
    inputs {
        /// What is selected by: heights.
        source: required,
    }
    params {
        /// The lowest and the highest value that are wholly selected, in the source's unit.
        range: [f64; 2] = [500.0, 1500.0], range -1e9 to 1e9;
        /// How far below and above the range it falls to 0, in the source's unit; 0 is a sharp end.
        falloff: [f64; 2] = [100.0, 100.0], range 0.0 to 1e9;
    }
    check |op| match op.range[0] <= op.range[1] {
        true => Ok(()),
        false => Err(("range", format!("the first number of `range` ({}) must not be above the second ({})", op.range[0], op.range[1]))),
    };
}

impl Field for SelectHeight {
    fn eval(&self, _: &Points, inputs: &Inputs, _: &WorldParams, out: &mut [f32]) {
        let selection = Selection::new(self.range, self.falloff);
        for (sample, source) in out.iter_mut().zip(inputs.required(0)) {
            *sample = selection.of(*source);
        }
    }

    fn cost(&self) -> f64 {
        1.0
    }
}
