//! A constant value.

use crate::lower::Lowering;
use crate::op::{Field, Inputs, WorldParams};
use orogen_grid::error::Result;
use orogen_noise::Points;
use orogen_noise::shader::function::Shader;

op! {
    /// The same value everywhere.
    pub struct Constant = "constant", field, revision 1;
    params {
        /// The value, in the unit that the nodes reading it expect.
        value: f64 = 0.0, range -1e9 to 1e9;
    }
}

/// The shader function of a constant, whose value is its only number.
pub(super) const CONSTANT: &str = "fn constant(base: u32, place: Placement) -> f32 { return number(base, 0u); }";

impl Field for Constant {
    fn eval(&self, _: &Points, _: &Inputs, _: &WorldParams, out: &mut [f32]) -> Result<()> {
        out.fill(self.value as f32);
        Ok(())
    }

    fn lower(&self, _: usize, _: &WorldParams) -> Lowering<Shader> {
        Lowering::Shader(Shader::new("constant", CONSTANT, &[self.value as f32]))
    }
}
