//! Indices of wetness and erosion from drainage area and slope.

use orogen_grid::parallel;

use crate::lower::{Lowering, Passes};
use crate::op::{Context, Filter, GridInputs, WorldParams};
use orogen_grid::analysis::slope::gradients_between;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::hydrology::wetness::{LevelGround, ls_factor, stream_power, wetness_index};

op! {
    /// Topographic wetness index, stream power index and LS factor, from the drainage area and the slope.
    ///
    /// a is the specific catchment area: the drainage area divided by the cell size, at least one cell's. b is the
    /// slope angle by Horn's 3 x 3 method. tan b is limited to at least `least_slope`, because the wetness of level
    /// ground would be infinite.
    pub struct FlowIndices = "flow-indices", filter, revision 1;
    inputs {
        /// The heights.
        source: required,
        /// The drainage area in m^2, such as `drainage.flow`.
        flow: required,
    }
    params {
        /// Minimum slope, rise over run.
        least_slope: f64 = 1e-3, range 1e-9 to 1.0;
    }
    layers {
        /// Topographic wetness index: ln(a / tan b) (Beven and Kirkby 1979).
        wetness: height;
        /// Stream power index: a tan b (Moore, Grayson and Ladson 1991).
        stream_power: flow, unit "m";
        /// LS factor of soil erosion: 1.4 (a / 22.13 m)^0.4 (sin b / 0.0896)^1.3 (Moore and Burch 1986).
        ls_factor: flow;
    }
}

const CODE: &str = concat!(include_str!("../lower/horn.wgsl"), include_str!("flow_indices.wgsl"));

impl Filter for FlowIndices {
    fn halo(&self, _: f64) -> usize {
        1
    }

    fn apply(&self, inputs: &GridInputs, window: &Window, out: &mut [Option<Grid>], context: &Context) -> Result<()> {
        let (source, flow) = (inputs.required("source")?, inputs.required("flow")?);
        let indices: [fn(f64, f64) -> f64; 3] = [wetness_index, stream_power, ls_factor];
        let level = LevelGround::default().with_least_slope(self.least_slope);
        for (layer, index) in out.iter_mut().zip(indices) {
            let Some(layer) = layer.as_mut().filter(|_| !window.is_empty()) else { continue };
            context.progress.expect(window.height as f64);
            parallel::try_for_each(layer.data_mut().chunks_mut(window.width).enumerate(), |(j, row)| {
                context.progress.step(1.0)?;
                let rows = [source.row(j), source.row(j + 1), source.row(j + 2)];
                let areas = &flow.row(j + 1)[1..];
                gradients_between(rows, window.cell, |i, gradient| {
                    let area = (f64::from(areas[i]) / window.cell).max(window.cell);
                    row[i] = index(area, level.slope(gradient.steepness())) as f32;
                });
                Ok(())
            })?;
        }
        Ok(())
    }

    fn lower(&self, cell: f64, _: &WorldParams) -> Lowering<Passes> {
        let numbers = [("gradient_scale", 1.0 / (8.0 * cell)), ("cell", cell), ("least_slope", self.least_slope)];
        Lowering::Shader(
            Passes::new(CODE, &[])
                .with_numbers(numbers.map(|(name, number)| (name, number as f32)))
                .then("indices", 0, [1; 2]),
        )
    }

    fn cost(&self, _: f64) -> f64 {
        25.0
    }
}
