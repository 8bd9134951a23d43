//! Slope and its components.

use crate::lower::{Lowering, Passes};
use crate::op::{Context, Filter, GridInputs, WorldParams};
use orogen_grid::analysis::slope::{degrees_between, steepness_between, values_between};
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::parallel;

choice! {
    /// Unit of a slope.
    pub enum SlopeUnit {
        /// Angle to the horizontal, 0 to 90 degrees.
        Degrees = "degrees",
        /// Rise over run: the tangent of the angle.
        Ratio = "ratio",
    }
}

op! {
    /// Slope of the source, taken as heights in metres, by Horn's 3 x 3 method (1981).
    ///
    /// The slope depends on the cell size: the same ground is gentler at a larger cell size. The components along the
    /// axes are layers: they tell the direction that the ground faces, and can displace other fields along it.
    pub struct Slope = "slope", filter, revision 1;
    inputs {
        /// The heights.
        source: required,
    }
    params {
        /// Unit of the slope.
        unit: SlopeUnit = SlopeUnit::Degrees;
    }
    layers {
        /// The slope, in degrees or as a ratio.
        slope: height;
        /// Rise per metre to the east; negative where the ground falls to the east.
        east: height;
        /// Rise per metre to the south; negative where the ground falls to the south.
        south: height;
    }
    units |op, layer| match (layer, op.unit) {
        (0, SlopeUnit::Degrees) => "deg",
        _ => "",
    };
}

const CODE: &str = concat!(include_str!("../lower/horn.wgsl"), include_str!("slope.wgsl"));

impl Slope {
    /// Fills a row of a layer from the rows of heights around it.
    fn fill(&self, layer: usize, rows: [&[f32]; 3], cell: f64, row: &mut [f32]) {
        match (layer, self.unit) {
            (0, SlopeUnit::Degrees) => degrees_between(rows, cell, row),
            (0, SlopeUnit::Ratio) => steepness_between(rows, cell, row),
            (1, _) => values_between(rows, cell, row, |gradient| gradient.east),
            _ => values_between(rows, cell, row, |gradient| -gradient.north),
        }
    }
}

impl Filter for Slope {
    fn halo(&self, _: f64) -> usize {
        1
    }

    fn apply(&self, inputs: &GridInputs, window: &Window, out: &mut [Option<Grid>], context: &Context) -> Result<()> {
        let source = inputs.required("source")?;
        for (index, layer) in out.iter_mut().enumerate() {
            let Some(layer) = layer.as_mut().filter(|_| !window.is_empty()) else { continue };
            context.progress.expect(window.height as f64);
            parallel::try_for_each(layer.data_mut().chunks_mut(window.width).enumerate(), |(j, row)| {
                context.progress.step(1.0)?;
                let rows = [source.row(j), source.row(j + 1), source.row(j + 2)];
                self.fill(index, rows, window.cell, row);
                Ok(())
            })?;
        }
        Ok(())
    }

    fn lower(&self, cell: f64, _: &WorldParams) -> Lowering<Passes> {
        let is_angle = self.unit == SlopeUnit::Degrees;
        let numbers = [("gradient_scale", (1.0 / (8.0 * cell)) as f32), ("is_angle", f32::from(u8::from(is_angle)))];
        Lowering::Shader(Passes::new(CODE, &[]).with_numbers(numbers).then("slopes", 0, [1; 2]))
    }
}
