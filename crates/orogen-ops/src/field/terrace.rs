//! Terraces, for mesas and rice fields.

use crate::lower::Lowering;
use crate::op::{Field, Inputs, WorldParams};
use orogen_grid::error::Result;
use orogen_noise::Points;
use orogen_noise::shader::function::Shader;

op! {
    /// The source quantized into terraces: level treads with smooth risers between them.
    ///
    /// Within each step the riser takes the middle share (1 - `sharpness`) as a smoothstep: 0 gives gentle waves, 1
    /// gives vertical cliffs.
    pub struct Terrace = "terrace", field, revision 1;
    inputs {
        /// The values to terrace.
        source: required,
    }
    params {
        /// Height of a step, in the source's unit.
        step: f64 = 0.1, range 1e-6 to 1e9;
        /// Steepness of the risers, from 0 (gentle) to 1 (vertical).
        sharpness: f64 = 0.7, range 0.0 to 1.0;
        /// Height of one of the treads, in the source's unit.
        offset: f64 = 0.0, range -1e9 to 1e9;
    }
}

impl Field for Terrace {
    fn eval(&self, _: &Points, inputs: &Inputs, _: &WorldParams, out: &mut [f32]) -> Result<()> {
        let (step, offset) = (self.step as f32, self.offset as f32);
        let riser = ((1.0 - self.sharpness) as f32).max(1e-3);
        for (sample, source) in out.iter_mut().zip(inputs.required("source")?) {
            let steps = (source - offset) / step;
            let tread = (steps + 0.5).floor();
            // -0.5 ..= 0.5 around the tread; the riser is centered between two treads.
            let t = steps - tread + 0.5;
            let rise = |t: f32| {
                let s = ((t - 0.5) / riser + 0.5).clamp(0.0, 1.0);
                s * s * (3.0 - 2.0 * s)
            };
            let share = if t < 0.5 { rise(t + 0.5) - 1.0 } else { rise(t - 0.5) };
            *sample = (tread + share) * step + offset;
        }
        Ok(())
    }

    fn cost(&self) -> f64 {
        2.0
    }

    fn lower(&self, _: usize, _: &WorldParams) -> Lowering<Shader> {
        let riser = ((1.0 - self.sharpness) as f32).max(1e-3);
        Lowering::Shader(Shader::new(
            "terrace",
            include_str!("terrace.wgsl"),
            &[self.step as f32, self.offset as f32, riser],
        ))
    }
}
