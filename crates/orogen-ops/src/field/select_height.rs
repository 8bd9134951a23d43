//! A mask by height.

use crate::lower::{Lowering, SELECTION};
use crate::op::{Field, Inputs, WorldParams};
use orogen_grid::analysis::selection::Selection;
use orogen_grid::error::Result;
use orogen_noise::Points;
use orogen_noise::shader::function::Shader;

op! {
    /// A mask by height: 1 inside a range of values, falling smoothly to 0 below and above it.
    ///
    /// The source may have any unit: heights, a layer of a filter or solver, or noise.
    pub struct SelectHeight = "select-height", field, revision 1;
    inputs {
        /// The values to select by, for example heights.
        source: required,
    }
    params {
        /// Lowest and highest value where the mask is 1, in the source's unit.
        range: [f64; 2] = [500.0, 1500.0], range -1e9 to 1e9;
        /// Width of the transition below and above the range, in the source's unit. 0 gives a sharp boundary.
        falloff: [f64; 2] = [100.0, 100.0], range 0.0 to 1e9;
    }
    check |op| match op.range[0] <= op.range[1] {
        true => Ok(()),
        false => Err(("range", format!("the first value of `range` ({}) must not be greater than the second ({})", op.range[0], op.range[1]))),
    };
}

impl Field for SelectHeight {
    fn eval(&self, _: &Points, inputs: &Inputs, _: &WorldParams, out: &mut [f32]) -> Result<()> {
        let selection = Selection::new(self.range, self.falloff);
        for (sample, source) in out.iter_mut().zip(inputs.required("source")?) {
            *sample = selection.of(*source);
        }
        Ok(())
    }

    fn cost(&self) -> f64 {
        1.0
    }

    fn lower(&self, _: usize, _: &WorldParams) -> Lowering<Shader> {
        const CODE: &str =
            "fn select_height(base: u32, place: Placement, source: f32) -> f32 { return selected(base, source); }";
        let [low, high, below, above] = [self.range[0], self.range[1], self.falloff[0], self.falloff[1]];
        let mut shader = Shader::new("select_height", CODE, &[low, high, below, above].map(|number| number as f32));
        shader.code.insert(0, SELECTION);
        Lowering::Shader(shader)
    }
}
