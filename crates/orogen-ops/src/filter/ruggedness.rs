//! Terrain ruggedness index.

use crate::lower::{Lowering, Passes};
use crate::op::{Context, Filter, GridInputs, WorldParams, only_layer};
use orogen_grid::analysis::roughness::riley_with;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};

op! {
    /// Terrain ruggedness index (TRI): the square root of the sum of squared height differences to the eight neighbors
    /// (Riley, DeGloria and Elliot 1999).
    ///
    /// The index depends on the cell size: the same ground has a higher index at a larger cell size.
    pub struct Ruggedness = "ruggedness", filter, revision 1;
    inputs {
        /// The heights.
        source: required,
    }
    layers {
        /// The index.
        ruggedness: height, unit "m";
    }
}

const CODE: &str = include_str!("ruggedness.wgsl");

impl Filter for Ruggedness {
    fn halo(&self, _: f64) -> usize {
        1
    }

    fn apply(&self, inputs: &GridInputs, _: &Window, out: &mut [Option<Grid>], context: &Context) -> Result<()> {
        let source = inputs.required("source")?;
        let out = only_layer(out)?;
        *out = riley_with(source, context.progress)?;
        Ok(())
    }

    fn lower(&self, _: f64, _: &WorldParams) -> Lowering<Passes> {
        Lowering::Shader(Passes::new(CODE, &[]).then("index", 0, [1; 2]))
    }
}
