//! A mask by slope.

use crate::lower::{Lowering, Passes};
use crate::op::{Context, Filter, GridInputs, WorldParams, only_layer};
use orogen_grid::analysis::selection::Selection;
use orogen_grid::analysis::slope::gradients_between;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::parallel;

op! {
    /// A mask by slope: 1 inside a range, falling smoothly to 0 below and above it.
    ///
    /// The slope is Horn's (1981), as in `slope`. It depends on the cell size: the same ground is gentler at a larger
    /// cell size.
    pub struct SelectSlope = "select-slope", filter, revision 1;
    inputs {
        /// The heights.
        source: required,
    }
    params {
        /// Lowest and highest slope where the mask is 1.
        range: [f64; 2] = [30.0, 90.0], unit "deg", range 0.0 to 90.0;
        /// Width of the transition below and above the range. 0 gives a sharp boundary.
        falloff: [f64; 2] = [10.0, 10.0], unit "deg", range 0.0 to 90.0;
    }
    check |op| match op.range[0] <= op.range[1] {
        true => Ok(()),
        false => Err(("range", format!("the first value of `range` ({}) must not be greater than the second ({})", op.range[0], op.range[1]))),
    };
}

const CODE: &str = concat!(
    include_str!("../lower/horn.wgsl"),
    include_str!("../lower/selection.wgsl"),
    include_str!("select_slope.wgsl")
);

impl Filter for SelectSlope {
    fn halo(&self, _: f64) -> usize {
        1
    }

    fn apply(&self, inputs: &GridInputs, window: &Window, out: &mut [Option<Grid>], context: &Context) -> Result<()> {
        let source = inputs.required("source")?;
        let out = only_layer(out)?;
        let selection = Selection::new(self.range, self.falloff);
        context.progress.expect(window.height as f64);
        parallel::try_for_each(out.data_mut().chunks_mut(window.width.max(1)).enumerate(), |(j, row)| {
            context.progress.step(1.0)?;
            gradients_between([source.row(j), source.row(j + 1), source.row(j + 2)], window.cell, |i, gradient| {
                row[i] = selection.of(gradient.degrees());
            });
            Ok(())
        })
    }

    fn lower(&self, cell: f64, _: &WorldParams) -> Lowering<Passes> {
        let [low, high, below, above] = Selection::new(self.range, self.falloff).numbers();
        let numbers = [(1.0 / (8.0 * cell)) as f32, low, high, below, above];
        Lowering::Shader(Passes::new(CODE, &numbers).then("select_slopes", 0, [1; 2]))
    }
}
