//! How steep it is.

use crate::analysis::slope::{Gradient, gradients_between};
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
    /// It is the slope between samples: on a coarser cell the same ground is gentler. Its parts along the axes are layers of
    /// their own: they say which way the ground faces, and move what reads them along it.
    pub struct Slope = "slope", filter, revision 1;
    inputs {
        /// The heights.
        source: required,
    }
    params {
        /// What the slope is told in.
        unit: SlopeUnit = SlopeUnit::Degrees;
    }
    layers {
        /// How steep it is, in degrees or as a ratio.
        slope: height;
        /// Rise per metre towards the east: negative where the ground falls eastward.
        east: height;
        /// Rise per metre towards the south.
        south: height;
    }
}

impl Filter for Slope {
    fn halo(&self, _: f64) -> usize {
        1
    }

    fn apply(
        &self,
        inputs: &[Option<&Grid>],
        window: &Window,
        out: &mut [Option<Grid>],
        context: &Context,
    ) -> Result<()> {
        let [Some(source)] = inputs else { return Ok(()) };
        let angle = |gradient: Gradient| match self.unit {
            SlopeUnit::Degrees => libm::atanf(gradient.steepness()).to_degrees(),
            SlopeUnit::Ratio => gradient.steepness(),
        };
        let values: [&(dyn Fn(Gradient) -> f32 + Sync); 3] =
            [&angle, &|gradient| gradient.east, &|gradient| -gradient.north];
        for (layer, value) in out.iter_mut().zip(values) {
            let Some(layer) = layer.as_mut().filter(|_| !window.is_empty()) else { continue };
            layer.data_mut().par_chunks_mut(window.width).enumerate().try_for_each(|(j, row)| {
                context.progress.check()?;
                let rows = [source.row(j), source.row(j + 1), source.row(j + 2)];
                gradients_between(rows, window.cell, |i, gradient| row[i] = value(gradient));
                Ok(())
            })?;
        }
        Ok(())
    }
}
