//! A filter for the test of adding things.

use crate::lower::{Lowering, Passes};
use crate::op::{Context, Filter, GridInputs, WorldParams, only_layer};
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};

op! {
    /// The rise: the height above the neighbor in the west.
    pub struct Added = "added-filter", filter, revision 1;
    inputs {
        /// The heights.
        source: required,
    }
    params {
        /// Factor of the rise.
        factor: f64 = 1.0, range -10.0 to 10.0;
    }
}

impl Filter for Added {
    fn halo(&self, _: f64) -> usize {
        1
    }

    fn apply(&self, inputs: &GridInputs, window: &Window, out: &mut [Option<Grid>], context: &Context) -> Result<()> {
        let source = inputs.required("source")?;
        let out = only_layer(out)?;
        context.progress.expect(window.height as f64);
        for (j, row) in out.data_mut().chunks_mut(window.width.max(1)).enumerate() {
            context.progress.step(1.0)?;
            for (rise, pair) in row.iter_mut().zip(source.row(j + 1).windows(2)) {
                *rise = (pair[1] - pair[0]) * self.factor as f32;
            }
        }
        Ok(())
    }

    fn lower(&self, _: f64, _: &WorldParams) -> Lowering<Passes> {
        Lowering::Shader(Passes::new(include_str!("added.wgsl"), &[self.factor as f32]).then("rise", 0, [1; 2]))
    }
}
