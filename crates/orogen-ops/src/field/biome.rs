//! Biomes by temperature and rain.

use super::evapotranspiration::{DEFAULT_RANGE, sample_or};
use crate::declare::Input;
use crate::lower::Lowering;
use crate::op::{Field, Inputs, WorldParams};
use orogen_grid::climate::biomes::class::{Climate, WATER};
use orogen_grid::climate::biomes::scheme;
use orogen_grid::climate::year::Year;
use orogen_grid::error::Result;
use orogen_noise::Points;
use orogen_noise::shader::function::Shader;

choice! {
    /// The classes of climates or biomes.
    pub enum BiomeScheme as scheme::Scheme {
        /// Ten biomes by mean temperature and rain (Whittaker 1975, as in Ricklefs 2008), with ice where no month is
        /// above 0 degrees C.
        Whittaker = "whittaker",
        /// 38 life zones by biotemperature, rain and potential evapotranspiration (Holdridge 1967).
        Holdridge = "holdridge",
        /// 30 climates by the temperatures and the rain of months (Köppen and Geiger; Peel, Finlayson and McMahon
        /// 2007).
        KoppenGeiger = "koppen-geiger",
    }
}

op! {
    /// The biome or the climate's class by temperature and rain.
    ///
    /// The layer has codes; their names and colors are in the chapter on climate. Months have temperatures of a
    /// sinusoidal year.
    pub struct Biome = "biome", field, revision 1;
    inputs {
        /// Mean temperature in degrees C, for example that of `temperature`.
        temperature: required,
        /// Rain in mm per year, for example that of `orographic-rain`.
        rain: required,
        /// Half the difference between the warmest and the coldest month in K. Default: 10.
        range: optional,
        /// Heights: at and below sea level the class is water (0). By default there is no water.
        height: optional,
    }
    params {
        /// The classes.
        scheme: BiomeScheme = BiomeScheme::Whittaker;
        /// When rain falls, for `koppen-geiger`: 0 evenly over the year, 1 in summer, -1 in winter. The rain of a month
        /// is 1 + `rain_seasonality` cos t of the mean, with t = 0 in the warmest month.
        rain_seasonality: f64 = 0.0, range -1.0 to 1.0;
    }
    layers {
        /// Code of the class, from 1; 0 is water.
        class: label;
    }
}

impl Field for Biome {
    fn eval(&self, _: &Points, inputs: &Inputs, world_params: &WorldParams, out: &mut [f32]) -> Result<()> {
        let scheme = scheme::Scheme::from(self.scheme);
        let (temperatures, rains) = (inputs.required("temperature")?, inputs.required("rain")?);
        let (ranges, heights) = (inputs.get("range"), inputs.get("height"));
        let sea_level = world_params.sea_level as f32;
        for (k, ((sample, mean), rain)) in out.iter_mut().zip(temperatures).zip(rains).enumerate() {
            let is_water = heights.is_some_and(|heights| heights.get(k).is_some_and(|height| *height <= sea_level));
            let code = if is_water {
                WATER
            } else {
                let range = sample_or(ranges, k, DEFAULT_RANGE).max(0.0);
                scheme.code(&Climate {
                    year: Year { mean: f64::from(*mean), range },
                    rain: f64::from(*rain).max(0.0),
                    seasonality: self.rain_seasonality,
                })
            };
            *sample = f32::from(code);
        }
        Ok(())
    }

    fn reads_sea_level(&self) -> bool {
        self.height != Input::None
    }

    fn cost(&self) -> f64 {
        match self.scheme {
            BiomeScheme::Whittaker => 5.0,
            BiomeScheme::Holdridge | BiomeScheme::KoppenGeiger => 60.0,
        }
    }

    fn lower(&self, _: usize, _: &WorldParams) -> Lowering<Shader> {
        Lowering::Processor("classes depend on months in f64")
    }
}
