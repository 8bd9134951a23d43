//! A mask by drainage area.

use crate::analysis::selection::Selection;
use crate::op::{Field, Inputs, WorldParams};
use orogen_noise::Points;

op! {
    /// A mask: 1 where a drainage area lies within a range, falling to 0 below and above it, smoothly in its logarithm.
    ///
    /// For the layer `flow` of `drainage`, `rivers`, `stream-power` or `local-stream-power`: brooks, rivers, or the crests where water only begins to
    /// gather.
    pub struct SelectFlow = "select-flow", field, revision 1;
    inputs {
        /// The drainage areas.
        source: required,
    }
    params {
        /// The smallest and the largest area that are wholly selected.
        range: [f64; 2] = [1e6, 1e18], unit "m^2", range 0.0 to 1e18;
        /// In how many powers of ten below and above the range it falls to 0; 0 is a sharp end.
        falloff: [f64; 2] = [1.0, 1.0], range 0.0 to 20.0;
    }
    check |op| match op.range[0] <= op.range[1] {
        true => Ok(()),
        false => Err(("range", format!("the first number of `range` ({}) must not be above the second ({})", op.range[0], op.range[1]))),
    };
}

impl Field for SelectFlow {
    fn eval(&self, _: &Points, inputs: &Inputs, _: &WorldParams, out: &mut [f32]) {
        let selection = Selection::new(self.range.map(libm::log10), self.falloff);
        for (sample, source) in out.iter_mut().zip(inputs.required(0)) {
            // No area at all lies below every other.
            *sample = selection.of(if *source > 0.0 { libm::log10f(*source) } else { f32::NEG_INFINITY });
        }
    }

    fn cost(&self) -> f64 {
        8.0
    }
}
