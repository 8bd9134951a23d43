//! A mask by curvature.

use crate::lower::{Lowering, Passes};
use crate::op::{Context, Filter, GridInputs, WorldParams, only_layer};
use orogen_grid::analysis::curvature::{Curvature, bend};
use orogen_grid::analysis::selection::Selection;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::parallel;

choice! {
    /// Kind of curvature.
    pub enum CurvatureKind {
        /// Mean curvature: convex on summits and crests, concave in hollows.
        Total = "total",
        /// Profile curvature, along the slope: convex at the upper edge of a slope, concave at its foot.
        Profile = "profile",
        /// Contour curvature: convex on spurs, where water diverges, concave in valleys, where it converges.
        Plan = "plan",
    }
}

op! {
    /// A mask by curvature: 1 inside a range, falling smoothly to 0 below and above it.
    ///
    /// The curvature is that of the quadric through nine heights `scale` apart (Zevenbergen and Thorne 1987). It is
    /// positive where the ground is convex; its unit is 1 over the radius of curvature. A large scale selects ridges
    /// and valleys, a small one selects details. A scale below half a cell counts as one cell.
    pub struct SelectCurvature = "select-curvature", filter, revision 1;
    inputs {
        /// The heights.
        source: required,
    }
    params {
        /// Kind of curvature.
        kind: CurvatureKind = CurvatureKind::Total;
        /// Distance between the heights, rounded to whole samples.
        scale: f64 = 50.0, unit "m", range 0.0 to 1e6;
        /// Lowest and highest curvature where the mask is 1. Concave ground has negative curvature.
        range: [f64; 2] = [1e-3, 1e3], unit "1/m", range -1e3 to 1e3;
        /// Width of the transition below and above the range. 0 gives a sharp boundary.
        falloff: [f64; 2] = [1e-3, 1e-3], unit "1/m", range 0.0 to 1e3;
    }
    check |op| match op.range[0] <= op.range[1] {
        true => Ok(()),
        false => Err(("range", format!("the first value of `range` ({}) must not be greater than the second ({})", op.range[0], op.range[1]))),
    };
}

impl CurvatureKind {
    /// The kind for the processor, and the number for shaders.
    pub(super) fn kind(self) -> (Curvature, f32) {
        match self {
            CurvatureKind::Total => (Curvature::Total, 0.0),
            CurvatureKind::Profile => (Curvature::Profile, 1.0),
            CurvatureKind::Plan => (Curvature::Plan, 2.0),
        }
    }
}

/// Maximum distance between the heights, in samples.
const FARTHEST: f64 = 16_384.0;

/// The distance between the heights in samples, for a distance and a cell in metres.
pub(super) fn samples_apart(scale: f64, cell: f64) -> usize {
    (scale / cell).round().clamp(1.0, FARTHEST) as usize
}

/// The curvatures of row `j` of a window, from heights that cover it and `apart` samples around it: calls `each` with
/// the index of each sample.
pub(super) fn curvatures(
    source: &Grid,
    j: usize,
    (apart, cell): (usize, f64),
    kind: Curvature,
    mut each: impl FnMut(usize, f32),
) {
    let distance = apart as f64 * cell;
    let rows = [0, 1, 2].map(|k| source.row(j + k * apart));
    for i in 0..source.width().saturating_sub(2 * apart) {
        let heights = rows.map(|row| [0, 1, 2].map(|k| f64::from(row[i + k * apart])));
        each(i, bend(heights, distance, kind));
    }
}

const CODE: &str = concat!(
    include_str!("../lower/horn.wgsl"),
    include_str!("second_difference.wgsl"),
    include_str!("../lower/curvature.wgsl"),
    include_str!("../lower/selection.wgsl"),
    include_str!("select_curvature.wgsl")
);

impl Filter for SelectCurvature {
    fn halo(&self, cell: f64) -> usize {
        samples_apart(self.scale, cell)
    }

    fn apply(&self, inputs: &GridInputs, window: &Window, out: &mut [Option<Grid>], context: &Context) -> Result<()> {
        let source = inputs.required("source")?;
        let out = only_layer(out)?;
        let selection = Selection::new(self.range, self.falloff);
        let apart = self.halo(window.cell);
        let (kind, _) = self.kind.kind();
        context.progress.expect(window.height as f64);
        parallel::try_for_each(out.data_mut().chunks_mut(window.width.max(1)).enumerate(), |(j, row)| {
            context.progress.step(1.0)?;
            curvatures(source, j, (apart, window.cell), kind, |i, bend| row[i] = selection.of(bend));
            Ok(())
        })
    }

    fn lower(&self, cell: f64, _: &WorldParams) -> Lowering<Passes> {
        let apart = self.halo(cell);
        let (_, kind) = self.kind.kind();
        let mut numbers = vec![apart as f32, (apart as f64 * cell) as f32, kind];
        numbers.extend(Selection::new(self.range, self.falloff).numbers());
        Lowering::Shader(Passes::new(CODE, &numbers).then("select_curvatures", 0, [apart; 2]))
    }

    fn cost(&self, _: f64) -> f64 {
        6.0
    }
}
