//! How steep it is.

use crate::analysis::slope::gradients_between;
use crate::error::Result;
use crate::grid::{Grid, Window};
use crate::op::{Context, Filter};
use rayon::prelude::*;

choice! {
    /// What a slope is told in.
    pub enum SlopeUnit {
        /// The angle to the horizontal, 0 to 90.
        Degrees = "degrees",
        /// Rise over run: the tangent of the angle.
        Ratio = "ratio",
    }
}

op! {
    /// Steepness of the source taken as heights in metres, by Horn's 3 x 3 method (1981).
    ///
    /// It is the slope between samples: on a coarser cell the same ground is gentler.
    pub struct Slope = "slope", filter, revision 1;
    inputs {
        /// The heights.
        source: required,
    }
    params {
        /// What the slope is told in.
        unit: SlopeUnit = SlopeUnit::Degrees;
    }
}

impl Filter for Slope {
    fn halo(&self, _: f64) -> usize {
        1
    }

    fn apply(&self, inputs: &[Option<&Grid>], window: &Window, context: &Context) -> Result<Vec<Grid>> {
        let mut out = Grid::filled(*window, 0.0f32);
        let [Some(source)] = inputs else { return Ok(vec![out]) };
        if window.is_empty() {
            return Ok(vec![out]);
        }
        out.data_mut().par_chunks_mut(window.width).enumerate().try_for_each(|(j, row)| {
            context.progress.check()?;
            let rows = [source.row(j), source.row(j + 1), source.row(j + 2)];
            gradients_between(rows, window.cell, |i, gradient| {
                let ratio = gradient.steepness();
                row[i] = match self.unit {
                    SlopeUnit::Degrees => libm::atanf(ratio).to_degrees(),
                    SlopeUnit::Ratio => ratio,
                };
            });
            Ok(())
        })?;
        Ok(vec![out])
    }
}
