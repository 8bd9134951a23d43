//! Aspect: the downhill direction.

use crate::lower::{Lowering, Passes};
use crate::op::{Context, Filter, GridInputs, WorldParams, only_layer};
use orogen_grid::analysis::aspect::aspect_of;
use orogen_grid::analysis::slope::gradients_between;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::parallel;

op! {
    /// Aspect: the downhill direction of the ground, in degrees clockwise from north.
    ///
    /// The slope is Horn's (1981), as in `slope`. Level ground has no aspect: its samples are missing (NaN). For masks,
    /// use `select-aspect`, which treats directions on both sides of north alike.
    pub struct Aspect = "aspect", filter, revision 1;
    inputs {
        /// The heights.
        source: required,
    }
    layers {
        /// The direction, from 0 to less than 360: 0 is north, 90 is east.
        aspect: height, unit "deg";
    }
}

const CODE: &str =
    concat!(include_str!("../lower/horn.wgsl"), include_str!("../lower/aspect.wgsl"), include_str!("aspect.wgsl"));

impl Filter for Aspect {
    fn halo(&self, _: f64) -> usize {
        1
    }

    fn apply(&self, inputs: &GridInputs, window: &Window, out: &mut [Option<Grid>], context: &Context) -> Result<()> {
        let source = inputs.required("source")?;
        let out = only_layer(out)?;
        context.progress.expect(window.height as f64);
        parallel::try_for_each(out.data_mut().chunks_mut(window.width.max(1)).enumerate(), |(j, row)| {
            context.progress.step(1.0)?;
            gradients_between([source.row(j), source.row(j + 1), source.row(j + 2)], window.cell, |i, gradient| {
                row[i] = aspect_of(gradient);
            });
            Ok(())
        })
    }

    fn lower(&self, cell: f64, _: &WorldParams) -> Lowering<Passes> {
        Lowering::Shader(Passes::new(CODE, &[(1.0 / (8.0 * cell)) as f32]).then("aspects", 0, [1; 2]))
    }

    fn cost(&self, _: f64) -> f64 {
        12.0
    }
}
