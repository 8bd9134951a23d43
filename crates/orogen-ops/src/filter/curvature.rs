//! Curvature of the ground.

use super::select_curvature::{CurvatureKind, curvatures, samples_apart};
use crate::lower::{Lowering, Passes};
use crate::op::{Context, Filter, GridInputs, WorldParams, only_layer};
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::parallel;

op! {
    /// Curvature of the ground: positive where it is convex, for example on ridges, and negative in hollows.
    ///
    /// The curvature is that of the quadric through nine heights `scale` apart (Zevenbergen and Thorne 1987). It is 1
    /// over the radius of curvature, and missing (NaN) where one of the nine heights is.
    pub struct Curvature = "curvature", filter, revision 1;
    inputs {
        /// The heights.
        source: required,
    }
    params {
        /// Kind of curvature.
        kind: CurvatureKind = CurvatureKind::Total;
        /// Distance between the heights, rounded to whole samples; at least one sample.
        scale: f64 = 0.0, unit "m", range 0.0 to 1e6;
    }
    layers {
        /// The curvature.
        curvature: height, unit "1/m";
    }
}

const CODE: &str = concat!(
    include_str!("second_difference.wgsl"),
    include_str!("../lower/curvature.wgsl"),
    include_str!("curvature.wgsl")
);

impl Filter for Curvature {
    fn halo(&self, cell: f64) -> usize {
        samples_apart(self.scale, cell)
    }

    fn apply(&self, inputs: &GridInputs, window: &Window, out: &mut [Option<Grid>], context: &Context) -> Result<()> {
        let source = inputs.required("source")?;
        let out = only_layer(out)?;
        let (apart, (kind, _)) = (self.halo(window.cell), self.kind.kind());
        context.progress.expect(window.height as f64);
        parallel::try_for_each(out.data_mut().chunks_mut(window.width.max(1)).enumerate(), |(j, row)| {
            context.progress.step(1.0)?;
            curvatures(source, j, (apart, window.cell), kind, |i, bend| row[i] = bend);
            Ok(())
        })
    }

    fn lower(&self, cell: f64, _: &WorldParams) -> Lowering<Passes> {
        let (apart, (_, kind)) = (self.halo(cell), self.kind.kind());
        let numbers = [apart as f32, (apart as f64 * cell) as f32, kind];
        Lowering::Shader(Passes::new(CODE, &numbers).then("curvatures", 0, [apart; 2]))
    }

    fn cost(&self, _: f64) -> f64 {
        5.0
    }
}
