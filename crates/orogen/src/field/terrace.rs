//! Steps: mesas and rice fields.

use crate::op::{Field, Inputs, WorldParams};
use orogen_noise::Points;

op! {
    /// The source pressed into steps: level treads with smooth risers between them.
    ///
    /// With t the share of the way from one step to the next, the riser takes the middle (1 - sharpness) of it as a smooth
    /// step, so 0 leaves gentle waves and 1 makes cliffs.
    pub struct Terrace = "terrace", field, revision 1;
    inputs {
        /// What is stepped.
        source: required,
    }
    params {
        /// Height of a step, in the source's unit.
        step: f64 = 0.1, range 1e-6 to 1e9;
        /// How steep the risers are.
        sharpness: f64 = 0.7, range 0.0 to 1.0;
        /// A height that lies on a tread, in the source's unit.
        offset: f64 = 0.0, range -1e9 to 1e9;
    }
}

impl Field for Terrace {
    fn eval(&self, _: &Points, inputs: &Inputs, _: &WorldParams, out: &mut [f32]) {
        let (step, offset) = (self.step as f32, self.offset as f32);
        let riser = ((1.0 - self.sharpness) as f32).max(1e-3);
        for (sample, source) in out.iter_mut().zip(inputs.required(0)) {
            let steps = (source - offset) / step;
            let tread = (steps + 0.5).floor();
            // -0.5 ..= 0.5 around the tread; the riser is centred between two treads.
            let t = steps - tread + 0.5;
            let rise = |t: f32| {
                let s = ((t - 0.5) / riser + 0.5).clamp(0.0, 1.0);
                s * s * (3.0 - 2.0 * s)
            };
            let share = if t < 0.5 { rise(t + 0.5) - 1.0 } else { rise(t - 0.5) };
            *sample = (tread + share) * step + offset;
        }
    }

    fn cost(&self) -> f64 {
        2.0
    }
}
