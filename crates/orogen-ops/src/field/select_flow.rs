//! A mask by drainage area.

use crate::lower::{Lowering, SELECTION};
use crate::op::{Field, Inputs, WorldParams};
use orogen_grid::analysis::selection::Selection;
use orogen_grid::error::Result;
use orogen_noise::Points;
use orogen_noise::shader::function::Shader;

op! {
    /// A mask by drainage area: 1 inside a range, falling smoothly to 0 below and above it, on a logarithmic scale.
    ///
    /// Use it with the layer `flow` of `drainage`, `rivers`, `stream-power` or `local-stream-power` to select brooks,
    /// rivers or crests.
    pub struct SelectFlow = "select-flow", field, revision 1;
    inputs {
        /// Drainage areas, in m^2.
        source: required,
    }
    params {
        /// Smallest and largest drainage area where the mask is 1.
        range: [f64; 2] = [1e6, 1e18], unit "m^2", range 0.0 to 1e18;
        /// Width of the transition below and above the range, in powers of ten. 0 gives a sharp boundary.
        falloff: [f64; 2] = [1.0, 1.0], range 0.0 to 20.0;
    }
    check |op| match op.range[0] <= op.range[1] {
        true => Ok(()),
        false => Err(("range", format!("the first value of `range` ({}) must not be greater than the second ({})", op.range[0], op.range[1]))),
    };
}

impl Field for SelectFlow {
    fn eval(&self, _: &Points, inputs: &Inputs, _: &WorldParams, out: &mut [f32]) -> Result<()> {
        let selection = Selection::new(self.range.map(libm::log10), self.falloff);
        for (sample, source) in out.iter_mut().zip(inputs.required("source")?) {
            // An area of 0 is below all others.
            *sample = selection.of(if *source > 0.0 { libm::log10f(*source) } else { f32::NEG_INFINITY });
        }
        Ok(())
    }

    fn cost(&self) -> f64 {
        8.0
    }

    fn lower(&self, _: usize, _: &WorldParams) -> Lowering<Shader> {
        // An area of 0 is below all others: 1e-38 m^2.
        const CODE: &str = "fn select_flow(base: u32, place: Placement, source: f32) -> f32 {
    return selected(base, select(-1e30, log2(max(source, 1e-38)) * 0.30102999566398120, source > 0.0));
}";
        // A lower end of 0 is below all areas.
        let [low, high] = self.range.map(|area| libm::log10(area).max(-1e29));
        let [below, above] = self.falloff;
        let mut shader = Shader::new("select_flow", CODE, &[low, high, below, above].map(|number| number as f32));
        shader.code.insert(0, SELECTION);
        Lowering::Shader(shader)
    }
}
