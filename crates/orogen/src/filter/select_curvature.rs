//! A mask by how the ground bends.

use crate::analysis::curvature::{Curvature, bend};
use crate::analysis::selection::Selection;
use crate::error::Result;
use crate::grid::{Grid, Window};
use crate::op::{Context, Filter};
use rayon::prelude::*;

choice! {
    /// Which way the ground is looked at.
    pub enum Bend {
        /// All ways together: convex on tops and crests, concave in hollows.
        Total = "total",
        /// Down the slope: convex on brows, concave at the foot.
        Profile = "profile",
        /// Along the contour: convex on spurs, where water spreads, concave in valleys, where it gathers.
        Plan = "plan",
    }
}

op! {
    /// A mask: 1 where the ground's curvature lies within a range, falling smoothly to 0 below and above it.
    ///
    /// The curvature is that of the quadric through nine heights (Zevenbergen and Thorne 1987) `scale` apart: positive where the ground is convex,
    /// one over the radius. A large scale sees ridges and valleys, a small one every stone; less than half a cell is a cell.
    pub struct SelectCurvature = "select-curvature", filter, revision 1;
    inputs {
        /// The heights.
        source: required,
    }
    params {
        /// Which way the ground is looked at.
        kind: Bend = Bend::Total;
        /// How far apart the heights are, to the nearest sample.
        scale: f64 = 50.0, unit "m", range 0.0 to 1e6;
        /// The least and the greatest curvature that are wholly selected: negative where the ground is concave.
        range: [f64; 2] = [1e-3, 1e3], unit "1/m", range -1e3 to 1e3;
        /// How far below and above the range it falls to 0; 0 is a sharp end.
        falloff: [f64; 2] = [1e-3, 1e-3], unit "1/m", range 0.0 to 1e3;
    }
    check |op| match op.range[0] <= op.range[1] {
        true => Ok(()),
        false => Err(("range", format!("the first number of `range` ({}) must not be above the second ({})", op.range[0], op.range[1]))),
    };
}

/// Most samples that heights may be apart.
const FARTHEST: f64 = 16_384.0;

impl Filter for SelectCurvature {
    fn halo(&self, cell: f64) -> usize {
        (self.scale / cell).round().clamp(1.0, FARTHEST) as usize
    }

    fn apply(
        &self,
        inputs: &[Option<&Grid>],
        window: &Window,
        out: &mut [Option<Grid>],
        context: &Context,
    ) -> Result<()> {
        let ([Some(source)], [Some(out)]) = (inputs, out) else { return Ok(()) };
        let selection = Selection::new(self.range, self.falloff);
        let apart = self.halo(window.cell);
        let distance = apart as f64 * window.cell;
        let kind = match self.kind {
            Bend::Total => Curvature::Total,
            Bend::Profile => Curvature::Profile,
            Bend::Plan => Curvature::Plan,
        };
        out.data_mut().par_chunks_mut(window.width.max(1)).enumerate().try_for_each(|(j, row)| {
            context.progress.check()?;
            let rows = [0, 1, 2].map(|k| source.row(j + k * apart));
            for (i, out) in row.iter_mut().enumerate() {
                let heights = rows.map(|row| [0, 1, 2].map(|k| f64::from(row[i + k * apart])));
                *out = selection.of(bend(heights, distance, kind));
            }
            Ok(())
        })
    }

    fn cost(&self, _: f64) -> f64 {
        6.0
    }
}
