//! How deep the soil is.

use crate::analysis::soil::Soil;
use crate::error::Result;
use crate::grid::{Grid, Window};
use crate::op::{Context, Filter};

op! {
    /// Depth of the soil on the source where production from bedrock keeps up with creep.
    ///
    /// Rock turns into soil at P0 exp(-h / h*) (Heimsath and others 1997), soil creeps downhill by K S / (1 - (S / Sc)^2) (Roering, Kirchner and Dietrich
    /// 1999); h = h* ln(ratio P0 / div q) is the depth at which both are equal (Pelletier and Rasmussen 2009). Crests have thin soil, the sharper the
    /// thinner; where more is carried away than bare rock makes, and from Sc on, there is none. Hollows and feet of slopes, to which soil is brought, have
    /// no such depth and get `deepest`. Fluxes are taken through the sides of each cell, from 3 x 3 heights: noise in the heights becomes noise in the depth,
    /// so blur rough ground first.
    pub struct SoilDepth = "soil-depth", filter, revision 1;
    inputs {
        /// The heights.
        source: required,
    }
    params {
        /// P0: production of soil from bare rock. 77 m in a million years at Tennessee Valley (Heimsath and others 1997).
        production: f64 = 7.7e-5, unit "m/yr", range 1e-9 to 1.0;
        /// h*: depth over which production falls by a factor e.
        decay: f64 = 0.43, unit "m", range 1e-3 to 100.0;
        /// K: how fast soil creeps.
        creep: f64 = 0.005, unit "m^2/yr", range 1e-9 to 1e3;
        /// Sc: slope, rise over run, on which no soil stays.
        critical_slope: f64 = 1.25, range 1e-3 to 100.0;
        /// Density of rock over that of soil.
        density_ratio: f64 = 2.0, range 0.1 to 10.0;
        /// The greatest depth.
        deepest: f64 = 2.0, unit "m", range 0.0 to 1000.0;
    }
    layers {
        /// The depth.
        depth: height, unit "m";
    }
}

impl Filter for SoilDepth {
    fn halo(&self, _: f64) -> usize {
        1
    }

    fn apply(&self, inputs: &[Option<&Grid>], _: &Window, out: &mut [Option<Grid>], context: &Context) -> Result<()> {
        let ([Some(source)], [Some(out)]) = (inputs, out) else { return Ok(()) };
        context.progress.check()?;
        let soil = Soil {
            production: self.production,
            decay: self.decay,
            creep: self.creep,
            critical_slope: self.critical_slope,
            density_ratio: self.density_ratio,
            deepest: self.deepest,
        };
        *out = soil.depths(source);
        Ok(())
    }

    fn cost(&self, _: f64) -> f64 {
        25.0
    }
}
