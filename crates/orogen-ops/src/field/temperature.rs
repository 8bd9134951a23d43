//! Temperature by latitude, height and distance from the sea.

use super::positions::each;
use crate::declare::Input;
use crate::lower::Lowering;
use crate::op::{Field, Inputs, WorldParams};
use orogen_grid::climate::temperature::{Temperature as Law, seasons};
use orogen_grid::error::Result;
use orogen_noise::Points;
use orogen_noise::shader::function::Shader;
use orogen_noise::shader::lattice::Lattice;

op! {
    /// Mean annual temperature of the air near the ground, and its range over the year.
    ///
    /// At sea level the mean is `equator` - (`equator` - `pole`) sin^2(latitude); the defaults are a fit to the
    /// observed means of latitudes (North, Cahalan and Coakley 1981). It falls by `lapse_rate` above the world's sea
    /// level. The range follows from Conrad's index of continentality K (1946): the difference between the warmest and
    /// the coldest month is (K + 14) sin(latitude + 10 degrees) / 1.7, with K = 0 at the sea and 100 d / (d +
    /// `continental_distance`) at a distance d from it. Both hemispheres are alike.
    pub struct Temperature = "temperature", field, revision 1;
    inputs {
        /// Heights. At and below sea level the temperature is that of the sea level.
        source: required,
        /// Distance from the sea in metres, for example that of `distance`, for the layer `range`. Default: that where
        /// K is `continentality`.
        sea_distance: optional,
        /// Temperature added to the mean in K, for example noise. Default: 0.
        anomaly: optional,
    }
    params {
        /// Latitude where y is 0, the world's northern edge; positive north of the equator.
        latitude: f64 = 45.0, unit "degrees", range -90.0 to 90.0;
        /// Distance of one degree of latitude. Smaller values make a small world that reaches from cold to warm.
        metres_per_degree: f64 = 111195.0, unit "m", range 1.0 to 1e7;
        /// Mean at sea level at the equator.
        equator: f64 = 29.0, unit "degrees C", range -100.0 to 100.0;
        /// Mean at sea level at the poles.
        pole: f64 = -13.0, unit "degrees C", range -100.0 to 100.0;
        /// Decrease with height.
        lapse_rate: f64 = 6.5, unit "K/km", range 0.0 to 20.0;
        /// Index of continentality K where `sea_distance` is not given: 0 at the sea, 100 in the middle of a large
        /// continent.
        continentality: f64 = 15.0, range 0.0 to 100.0;
        /// Distance from the sea at which K is 50.
        continental_distance: f64 = 900000.0, unit "m", range 1.0 to 1e9;
    }
    layers {
        /// Mean over the year.
        mean: height, unit "degrees C";
        /// Half the difference between the warmest and the coldest month.
        range: height, unit "K";
    }
}

impl Temperature {
    fn law(&self) -> Law {
        Law::default()
            .with_equator(self.equator)
            .with_pole(self.pole)
            .with_lapse_rate(self.lapse_rate)
            .with_latitude(self.latitude)
            .with_metres_per_degree(self.metres_per_degree)
            .with_continental_distance(self.continental_distance)
    }

    fn mean(&self, at: &Points, inputs: &Inputs, world_params: &WorldParams, out: &mut [f32]) -> Result<()> {
        let law = self.law();
        by_row(at, out, |south| law.at_sea_level(south));
        for (sample, height) in out.iter_mut().zip(inputs.required("source")?) {
            *sample = (f64::from(*sample) - law.decrease(f64::from(*height) - world_params.sea_level)) as f32;
        }
        if let Some(anomaly) = inputs.get("anomaly") {
            out.iter_mut().zip(anomaly).for_each(|(sample, anomaly)| *sample += anomaly);
        }
        Ok(())
    }

    fn range(&self, at: &Points, inputs: &Inputs, out: &mut [f32]) {
        let law = self.law();
        by_row(at, out, |south| law.seasonality(south));
        match inputs.get("sea_distance") {
            Some(distances) => {
                for (sample, distance) in out.iter_mut().zip(distances) {
                    *sample *= seasons(law.continentality(f64::from(*distance))) as f32;
                }
            }
            None => {
                let seasons = seasons(self.continentality) as f32;
                out.iter_mut().for_each(|sample| *sample *= seasons);
            }
        }
    }
}

/// Writes a function of the position south at each point. It is computed once for successive points of a row.
fn by_row(at: &Points, out: &mut [f32], value: impl Fn(f64) -> f64) {
    let (mut row, mut there) = (f64::NAN, 0.0);
    each(at, out, |_, south| {
        if south != row {
            (row, there) = (south, value(south) as f32);
        }
        there
    });
}

impl Field for Temperature {
    fn eval_layer(
        &self,
        layer: usize,
        at: &Points,
        inputs: &Inputs,
        world_params: &WorldParams,
        out: &mut [f32],
    ) -> Result<()> {
        match layer {
            0 => self.mean(at, inputs, world_params, out),
            _ => {
                self.range(at, inputs, out);
                Ok(())
            }
        }
    }

    fn reads_sea_level(&self) -> bool {
        true
    }

    fn cost(&self) -> f64 {
        3.0
    }

    fn lower(&self, layer: usize, world_params: &WorldParams) -> Lowering<Shader> {
        let flag = |input: &Input| if *input == Input::None { 0.0 } else { 1.0 };
        let numbers = [
            self.latitude,
            self.equator,
            self.pole,
            self.lapse_rate / 1000.0,
            world_params.sea_level,
            flag(&self.sea_distance),
            self.continental_distance,
            seasons(self.continentality),
        ];
        let name = if layer == 0 { "temperature_mean" } else { "temperature_range" };
        let shader = Shader::new(name, include_str!("temperature.wgsl"), &numbers.map(|number| number as f32));
        // Degrees south of the northern edge.
        Lowering::Shader(shader.on(Lattice::metres(self.metres_per_degree, [0.0, 0.0])))
    }
}
