//! A mask by aspect.

use crate::lower::{Lowering, Passes};
use crate::op::{Context, Filter, GridInputs, WorldParams, only_layer};
use orogen_grid::analysis::aspect::aspect_of;
use orogen_grid::analysis::selection::Selection;
use orogen_grid::analysis::slope::gradients_between;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::parallel;

op! {
    /// A mask by aspect: 1 where the ground faces a direction, falling smoothly to 0 away from it.
    ///
    /// Use it for snow on northern slopes or rain from the west. Aspect is the downhill direction by Horn's method
    /// (1981). Level ground has no aspect: the mask falls to 0 for slopes below `least_slope`.
    pub struct SelectAspect = "select-aspect", filter, revision 1;
    inputs {
        /// The heights.
        source: required,
    }
    params {
        /// The direction: 0 is north, 90 is east.
        direction: f64 = 0.0, unit "deg", range -360.0 to 360.0;
        /// Angle to each side of the direction within which the mask is 1.
        width: f64 = 30.0, unit "deg", range 0.0 to 180.0;
        /// Width of the transition beyond `width`. 0 gives a sharp boundary.
        falloff: f64 = 60.0, unit "deg", range 0.0 to 180.0;
        /// Slope above which the mask is not reduced.
        least_slope: f64 = 5.0, unit "deg", range 0.0 to 89.0;
    }
}

const CODE: &str = concat!(
    include_str!("../lower/horn.wgsl"),
    include_str!("../lower/aspect.wgsl"),
    include_str!("../lower/selection.wgsl"),
    include_str!("select_aspect.wgsl")
);

impl Filter for SelectAspect {
    fn halo(&self, _: f64) -> usize {
        1
    }

    fn apply(&self, inputs: &GridInputs, window: &Window, out: &mut [Option<Grid>], context: &Context) -> Result<()> {
        let source = inputs.required("source")?;
        let out = only_layer(out)?;
        let directions = Selection::new([-1.0, self.width], [0.0, self.falloff]);
        let slopes = Selection::new([self.least_slope, 90.0], [self.least_slope, 0.0]);
        let direction = self.direction as f32;
        context.progress.expect(window.height as f64);
        parallel::try_for_each(out.data_mut().chunks_mut(window.width.max(1)).enumerate(), |(j, row)| {
            context.progress.step(1.0)?;
            gradients_between([source.row(j), source.row(j + 1), source.row(j + 2)], window.cell, |i, gradient| {
                let off = (aspect_of(gradient) - direction).abs() % 360.0;
                // The smaller of the two angles. Level ground, whose aspect is NaN, is not selected.
                let off = if off > 180.0 { 360.0 - off } else { off };
                row[i] = directions.of(off) * slopes.of(gradient.degrees());
            });
            Ok(())
        })
    }

    fn lower(&self, cell: f64, _: &WorldParams) -> Lowering<Passes> {
        let directions = Selection::new([-1.0, self.width], [0.0, self.falloff]).numbers();
        let slopes = Selection::new([self.least_slope, 90.0], [self.least_slope, 0.0]).numbers();
        let mut numbers = vec![(1.0 / (8.0 * cell)) as f32, self.direction as f32];
        numbers.extend(directions.into_iter().chain(slopes));
        Lowering::Shader(Passes::new(CODE, &numbers).then("select_aspects", 0, [1; 2]))
    }

    fn cost(&self, _: f64) -> f64 {
        15.0
    }
}
