//! Potential evapotranspiration.

use crate::lower::Lowering;
use crate::op::{Field, Inputs, WorldParams};
use orogen_grid::climate::evapotranspiration::{humidity, potential};
use orogen_grid::climate::year::Year;
use orogen_grid::error::Result;
use orogen_noise::Points;
use orogen_noise::shader::function::Shader;

op! {
    /// Potential evapotranspiration: water that plants and soil would evaporate in a year if it were there.
    ///
    /// It is 58.93 mm for each degree of biotemperature, the mean over the months of temperatures limited to 0 to 30
    /// degrees C (Holdridge 1967). The months are those of a sinusoidal year.
    pub struct Evapotranspiration = "evapotranspiration", field, revision 1;
    inputs {
        /// Mean temperature in degrees C, for example that of `temperature`.
        temperature: required,
        /// Half the difference between the warmest and the coldest month in K. Default: 10.
        range: optional,
        /// Rain in mm per year, for the layer `humidity`. Default: 1000.
        rain: optional,
    }
    layers {
        /// Potential evapotranspiration.
        potential: height, unit "mm/yr";
        /// Rain over potential evapotranspiration, at most 100 (aridity index of UNEP 1992): below 0.05 hyperarid, 0.2
        /// arid, 0.5 semi-arid, 0.65 dry subhumid.
        humidity: height;
    }
}

/// Default of half the difference between the warmest and the coldest month, in K.
pub(super) const DEFAULT_RANGE: f32 = 10.0;
/// Default of the rain, in mm per year.
pub(super) const DEFAULT_RAIN: f32 = 1000.0;

/// The sample of an input, or its default.
pub(super) fn sample_or(input: Option<&[f32]>, k: usize, default: f32) -> f64 {
    f64::from(input.and_then(|input| input.get(k)).copied().unwrap_or(default))
}

impl Field for Evapotranspiration {
    fn eval_layer(&self, layer: usize, _: &Points, inputs: &Inputs, _: &WorldParams, out: &mut [f32]) -> Result<()> {
        let (ranges, rains) = (inputs.get("range"), inputs.get("rain"));
        for (k, (sample, mean)) in out.iter_mut().zip(inputs.required("temperature")?).enumerate() {
            let range = sample_or(ranges, k, DEFAULT_RANGE).max(0.0);
            let potential = potential(&Year { mean: f64::from(*mean), range });
            *sample = match layer {
                0 => potential as f32,
                _ => humidity(sample_or(rains, k, DEFAULT_RAIN), potential) as f32,
            };
        }
        Ok(())
    }

    fn cost(&self) -> f64 {
        12.0
    }

    fn lower(&self, _: usize, _: &WorldParams) -> Lowering<Shader> {
        Lowering::Processor("it is a sum over months in f64")
    }
}
