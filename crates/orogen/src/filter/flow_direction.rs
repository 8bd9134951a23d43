//! Directions of flow as other programs number them.

use crate::error::Result;
use crate::grid::{Grid, Window};
use crate::hydrology::direction::Convention;
use crate::op::{Context, Filter};

choice! {
    /// How directions are numbered.
    pub enum Codes {
        /// ArcGIS and pysheds: 1 east, 2 south-east, 4 south, 8 south-west, 16 west, 32 north-west, 64 north, 128 north-east; 0 where water leaves.
        Esri = "esri",
        /// GRASS (r.watershed): from 1 north-east counter-clockwise to 8 east; 0 where water leaves.
        Grass = "grass",
        /// TauDEM: from 1 east counter-clockwise to 8 south-east; 0 where water leaves.
        Taudem = "taudem",
        /// WhiteboxTools: 1 north-east, 2 east, 4 south-east, 8 south, 16 south-west, 32 west, 64 north-west, 128 north; 0 where water leaves.
        Whitebox = "whitebox",
        /// PCRaster: a numeric keypad, 7 north-west to 3 south-east; 5 where water leaves.
        Pcraster = "pcraster",
    }
}

op! {
    /// Directions of flow, `drainage.receiver`, renumbered as another program numbers them.
    pub struct FlowDirection = "flow-direction", filter, revision 1;
    inputs {
        /// Directions as `drainage.receiver` numbers them: clockwise from the east (0) to the north-east (7), 8 where water leaves.
        source: required,
    }
    params {
        /// How they are numbered.
        codes: Codes = Codes::Esri;
    }
    layers {
        /// The direction.
        direction: label;
    }
}

impl Filter for FlowDirection {
    fn halo(&self, _: f64) -> usize {
        0
    }

    fn apply(&self, inputs: &[Option<&Grid>], _: &Window, out: &mut [Option<Grid>], _: &Context) -> Result<()> {
        let ([Some(source)], [Some(out)]) = (inputs, out) else { return Ok(()) };
        let convention = match self.codes {
            Codes::Esri => Convention::ESRI,
            Codes::Grass => Convention::GRASS,
            Codes::Taudem => Convention::TAUDEM,
            Codes::Whitebox => Convention::WHITEBOX,
            Codes::Pcraster => Convention::PCRASTER,
        };
        for (out, code) in out.data_mut().iter_mut().zip(source.data()) {
            *out = f32::from(convention.of(*code as u8));
        }
        Ok(())
    }
}
