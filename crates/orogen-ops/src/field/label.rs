//! Whole numbers as labels.

use crate::lower::Lowering;
use crate::op::{Field, Inputs, WorldParams};
use orogen_grid::error::Result;
use orogen_noise::Points;
use orogen_noise::shader::function::Shader;

op! {
    /// The source as labels: rounded to whole numbers, and read at the nearest sample instead of interpolated.
    ///
    /// Numbers of classes that other ops compute, such as `expr`, are exported as they are once they are labels: a .png
    /// has the number in each pixel, and between stored samples there are no classes that the source does not have.
    pub struct Label = "label", field, revision 1;
    inputs {
        /// The numbers.
        source: required,
    }
    layers {
        /// The rounded source; halves are rounded away from zero.
        label: label;
    }
}

impl Field for Label {
    fn eval(&self, _: &Points, inputs: &Inputs, _: &WorldParams, out: &mut [f32]) -> Result<()> {
        for (sample, source) in out.iter_mut().zip(inputs.required("source")?) {
            *sample = source.round();
        }
        Ok(())
    }

    fn cost(&self) -> f64 {
        0.5
    }

    fn lower(&self, _: usize, _: &WorldParams) -> Lowering<Shader> {
        const CODE: &str = "fn label(base: u32, place: Placement, source: f32) -> f32 { return rounded(source); }";
        Lowering::Shader(Shader::new("label", CODE, &[]))
    }
}
