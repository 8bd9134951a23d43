//! Surface normals.

use crate::lower::{Lowering, Passes};
use crate::op::{Context, Filter, GridInputs, WorldParams};
use orogen_grid::analysis::slope::gradients_between;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::parallel;

op! {
    /// The upward unit normal of the ground: its components to the east, north and up.
    ///
    /// The slope is Horn's (1981), as in `slope`.
    pub struct Normal = "normal", filter, revision 1;
    inputs {
        /// The heights.
        source: required,
    }
    layers {
        /// Component to the east, -1 to 1.
        east: height;
        /// Component to the north, -1 to 1.
        north: height;
        /// Upward component, 0 to 1; 1 on level ground.
        up: height;
    }
}

const CODE: &str = concat!(include_str!("../lower/horn.wgsl"), include_str!("normal.wgsl"));

impl Filter for Normal {
    fn halo(&self, _: f64) -> usize {
        1
    }

    fn apply(&self, inputs: &GridInputs, window: &Window, out: &mut [Option<Grid>], context: &Context) -> Result<()> {
        let source = inputs.required("source")?;
        // One pass over the heights serves all components.
        let mut rows: Vec<Vec<(usize, &mut [f32])>> = (0..window.height).map(|_| Vec::new()).collect();
        for (part, grid) in out.iter_mut().enumerate() {
            let Some(grid) = grid else { continue };
            rows.iter_mut()
                .zip(grid.data_mut().chunks_mut(window.width.max(1)))
                .for_each(|(row, samples)| row.push((part, samples)));
        }
        context.progress.expect(window.height as f64);
        parallel::try_for_each(rows.into_iter().enumerate(), |(j, mut row)| {
            context.progress.step(1.0)?;
            gradients_between([source.row(j), source.row(j + 1), source.row(j + 2)], window.cell, |i, gradient| {
                let normal = gradient.normal();
                row.iter_mut().for_each(|(part, samples)| samples[i] = normal[*part]);
            });
            Ok(())
        })
    }

    fn lower(&self, cell: f64, _: &WorldParams) -> Lowering<Passes> {
        Lowering::Shader(Passes::new(CODE, &[(1.0 / (8.0 * cell)) as f32]).then("normal", 0, [1; 2]))
    }
}
