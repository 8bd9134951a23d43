//! Flow directions in the encodings of other programs.

use crate::lower::{Lowering, Passes};
use crate::op::{Context, Filter, GridInputs, WorldParams, only_layer};
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::hydrology::direction::{Convention, NONE};

choice! {
    /// Encoding of flow directions.
    pub enum FlowCodes {
        /// ArcGIS and pysheds: 1 east, 2 south-east, 4 south, 8 south-west, 16 west, 32 north-west, 64 north, 128
        /// north-east; 0 at outlets.
        Esri = "esri",
        /// GRASS (r.watershed): from 1 north-east counter-clockwise to 8 east; 0 at outlets.
        Grass = "grass",
        /// TauDEM: from 1 east counter-clockwise to 8 south-east; 0 at outlets.
        Taudem = "taudem",
        /// WhiteboxTools: 1 north-east, 2 east, 4 south-east, 8 south, 16 south-west, 32 west, 64 north-west, 128
        /// north; 0 at outlets.
        Whitebox = "whitebox",
        /// PCRaster: numeric keypad, 7 north-west to 3 south-east; 5 at outlets.
        Pcraster = "pcraster",
    }
}

op! {
    /// Flow directions (`drainage.receiver`), converted to the encoding of another program.
    pub struct FlowDirection = "flow-direction", filter, revision 1;
    inputs {
        /// Flow directions as `drainage.receiver` encodes them: clockwise from east (0) to north-east (7), 8 at
        /// outlets.
        source: required,
    }
    params {
        /// The target encoding.
        codes: FlowCodes = FlowCodes::Esri;
    }
    layers {
        /// The flow direction.
        direction: label;
    }
}

const CODE: &str = include_str!("flow_direction.wgsl");

impl Filter for FlowDirection {
    fn halo(&self, _: f64) -> usize {
        0
    }

    fn apply(&self, inputs: &GridInputs, _: &Window, out: &mut [Option<Grid>], _: &Context) -> Result<()> {
        let source = inputs.required("source")?;
        let out = only_layer(out)?;
        let convention = self.convention();
        for (out, code) in out.data_mut().iter_mut().zip(source.data()) {
            *out = f32::from(convention.of(*code as u8));
        }
        Ok(())
    }

    fn lower(&self, _: f64, _: &WorldParams) -> Lowering<Passes> {
        let convention = self.convention();
        let codes: Vec<f32> = (0..=NONE).map(|code| f32::from(convention.of(code))).collect();
        Lowering::Shader(Passes::new(CODE, &codes).then("convert", 0, [0; 2]))
    }
}

impl FlowDirection {
    fn convention(&self) -> Convention {
        match self.codes {
            FlowCodes::Esri => Convention::ESRI,
            FlowCodes::Grass => Convention::GRASS,
            FlowCodes::Taudem => Convention::TAUDEM,
            FlowCodes::Whitebox => Convention::WHITEBOX,
            FlowCodes::Pcraster => Convention::PCRASTER,
        }
    }
}
