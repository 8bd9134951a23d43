//! Hillshade.

use crate::lower::{Lowering, Passes};
use crate::op::{Context, Filter, GridInputs, WorldParams, only_layer};
use orogen_grid::analysis::hillshade::{Light, hillshade_between};
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::parallel;

op! {
    /// Hillshade: how much light of a distant source the ground receives, from 0 (none) to 1 (full).
    ///
    /// The slope is Horn's (1981), as in `slope`; ground does not cast shadows. Level ground gets the sine of the
    /// altitude, and missing heights get 0.
    pub struct Hillshade = "hillshade", filter, revision 1;
    inputs {
        /// The heights.
        source: required,
    }
    params {
        /// Direction that the light of a hillshade comes from, clockwise from north.
        azimuth: f64 = 315.0, unit "degrees", range -360.0 to 360.0;
        /// Height of the light of a hillshade above the horizon (90: straight above).
        altitude: f64 = 45.0, unit "degrees", range 0.0 to 90.0;
        /// Factor of the heights before a hillshade is computed.
        z_factor: f64 = 1.0, range 0.0 to 1e6;
    }
    layers {
        /// The light.
        hillshade: height;
    }
}

const CODE: &str = concat!(include_str!("../lower/horn.wgsl"), include_str!("hillshade.wgsl"));

impl Hillshade {
    fn light(&self) -> Light {
        Light::new(self.azimuth, self.altitude, self.z_factor)
    }
}

impl Filter for Hillshade {
    fn halo(&self, _: f64) -> usize {
        1
    }

    fn apply(&self, inputs: &GridInputs, window: &Window, out: &mut [Option<Grid>], context: &Context) -> Result<()> {
        let source = inputs.required("source")?;
        let out = only_layer(out)?;
        let light = self.light();
        context.progress.expect(window.height as f64);
        parallel::try_for_each(out.data_mut().chunks_mut(window.width.max(1)).enumerate(), |(j, row)| {
            context.progress.step(1.0)?;
            hillshade_between([source.row(j), source.row(j + 1), source.row(j + 2)], window.cell, &light, row);
            Ok(())
        })
    }

    fn lower(&self, cell: f64, _: &WorldParams) -> Lowering<Passes> {
        let [east, north, up, z_factor] = self.light().numbers();
        let numbers = [(1.0 / (8.0 * cell)) as f32, east, north, up, z_factor];
        Lowering::Shader(Passes::new(CODE, &numbers).then("hillshade", 0, [1; 2]))
    }

    fn cost(&self, _: f64) -> f64 {
        2.0
    }
}
