//! Maps one range to another.

use crate::lower::Lowering;
use crate::op::{Field, Inputs, WorldParams};
use orogen_grid::error::Result;
use orogen_noise::Points;
use orogen_noise::shader::function::Shader;

op! {
    /// The source with the range `from` mapped linearly to the range `to`. With [1, 0] as either range the source is
    /// inverted.
    pub struct Remap = "remap", field, revision 1;
    inputs {
        /// The values to map.
        source: required,
    }
    params {
        /// Two source values that are mapped to the two values of `to`. They must differ.
        from: [f64; 2] = [-1.0, 1.0], range -1e9 to 1e9;
        /// The values that they are mapped to.
        to: [f64; 2] = [0.0, 1.0], range -1e9 to 1e9;
        /// Whether results beyond `to` are limited to it. Otherwise the mapping continues linearly.
        clamp: bool = false;
    }
    check |op| match op.from[0] != op.from[1] && (op.from[1] - op.from[0]).abs() >= 1e-9 {
        true => Ok(()),
        false => Err(("from", "the two numbers of `from` must differ by at least 1e-9".to_string())),
    };
}

impl Field for Remap {
    fn eval(&self, _: &Points, inputs: &Inputs, _: &WorldParams, out: &mut [f32]) -> Result<()> {
        let scale = ((self.to[1] - self.to[0]) / (self.from[1] - self.from[0])) as f32;
        let (from, to) = (self.from[0] as f32, self.to[0] as f32);
        let (low, high) = match self.clamp {
            true => (self.to[0].min(self.to[1]) as f32, self.to[0].max(self.to[1]) as f32),
            false => (f32::NEG_INFINITY, f32::INFINITY),
        };
        for (sample, source) in out.iter_mut().zip(inputs.required("source")?) {
            *sample = ((source - from) * scale + to).clamp(low, high);
        }
        Ok(())
    }

    fn lower(&self, _: usize, _: &WorldParams) -> Lowering<Shader> {
        const CODE: &str = "fn remap(base: u32, place: Placement, source: f32) -> f32 {
    let value = (source - number(base, 0u)) * number(base, 1u) + number(base, 2u);
    return select(value, clamp(value, number(base, 3u), number(base, 4u)), number(base, 5u) != 0.0);
}";
        let scale = (self.to[1] - self.to[0]) / (self.from[1] - self.from[0]);
        let (low, high) = (self.to[0].min(self.to[1]), self.to[0].max(self.to[1]));
        let is_clamped = if self.clamp { 1.0 } else { 0.0 };
        let numbers = [self.from[0], scale, self.to[0], low, high, is_clamped].map(|number| number as f32);
        Lowering::Shader(Shader::new("remap", CODE, &numbers))
    }
}
