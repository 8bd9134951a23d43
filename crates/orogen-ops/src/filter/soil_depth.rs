//! Steady-state soil depth.

use crate::lower::{Lowering, Passes};
use crate::op::{Context, Filter, GridInputs, WorldParams, only_layer};
use orogen_grid::analysis::soil::Soil;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};

op! {
    /// Steady-state soil depth: the depth at which soil production from bedrock balances soil creep.
    ///
    /// Rock turns into soil at the rate P0 exp(-h / h*) (Heimsath and others 1997). Soil creeps downhill with the flux
    /// q = K S / (1 - (S / Sc)^2) (Roering, Kirchner and Dietrich 1999). h = h* ln(ratio P0 / div q) is the depth at
    /// which both are equal (Pelletier and Rasmussen 2009). Soil is thin on crests, and thinner the sharper they are.
    /// There is none where more is removed than bare rock produces, and none on slopes of Sc and above. Hollows and
    /// foot slopes, where soil accumulates, have no steady-state depth and get `deepest`. Fluxes are taken through the
    /// sides of each cell, from 3 x 3 heights: noise in the heights becomes noise in the depth, so blur rough ground
    /// first.
    pub struct SoilDepth = "soil-depth", filter, revision 1;
    inputs {
        /// The heights.
        source: required,
    }
    params {
        /// P0: soil production rate of bare rock. 77 m per million years was measured at Tennessee Valley (Heimsath and
        /// others 1997).
        production: f64 = 7.7e-5, unit "m/yr", range 1e-9 to 1.0;
        /// h*: depth over which production falls by the factor e.
        decay: f64 = 0.43, unit "m", range 1e-3 to 100.0;
        /// K: diffusivity of soil creep.
        creep: f64 = 0.005, unit "m^2/yr", range 1e-9 to 1e3;
        /// Sc: critical slope, rise over run, from which on there is no soil.
        critical_slope: f64 = 1.25, range 1e-3 to 100.0;
        /// Ratio of rock density to soil density.
        density_ratio: f64 = 2.0, range 0.1 to 10.0;
        /// Maximum depth.
        deepest: f64 = 2.0, unit "m", range 0.0 to 1000.0;
    }
    layers {
        /// The soil depth.
        depth: height, unit "m";
    }
}

const CODE: &str = concat!(
    include_str!("../lower/horn.wgsl"),
    include_str!("second_difference.wgsl"),
    include_str!("soil_depth.wgsl")
);

impl Filter for SoilDepth {
    fn halo(&self, _: f64) -> usize {
        1
    }

    fn apply(&self, inputs: &GridInputs, _: &Window, out: &mut [Option<Grid>], context: &Context) -> Result<()> {
        let source = inputs.required("source")?;
        let out = only_layer(out)?;
        let soil = Soil::default()
            .with_production(self.production)
            .with_decay(self.decay)
            .with_creep(self.creep)
            .with_critical_slope(self.critical_slope)
            .with_density_ratio(self.density_ratio)
            .with_deepest(self.deepest);
        *out = soil.depths_with(source, context.progress)?;
        Ok(())
    }

    fn lower(&self, cell: f64, _: &WorldParams) -> Lowering<Passes> {
        let made = self.density_ratio * self.production;
        let numbers = [
            ("cell", cell),
            ("critical_slope", self.critical_slope),
            ("creep", self.creep),
            ("decay", self.decay),
            ("made", made),
            ("deepest", self.deepest),
        ];
        let numbers = numbers.map(|(name, number)| (name, number as f32));
        Lowering::Shader(Passes::new(CODE, &[]).with_numbers(numbers).then("depths", 0, [1; 2]))
    }

    fn cost(&self, _: f64) -> f64 {
        25.0
    }
}
