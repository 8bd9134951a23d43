//! Running a program over a window at several altitudes.

use super::inline::put;
use super::run::Engine;
use crate::plan::steps::Plan;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;
use orogen_grid::parallel;
use orogen_ops::interpreter::Interpreter;
use orogen_ops::program::{BLOCK_HEIGHT, BLOCK_WIDTH};

impl Engine<'_> {
    /// Computes the samples of a plan for points at each sample of its window and each altitude, slice by slice, each
    /// row-major.
    pub fn volume(&self, plan: &Plan, altitudes: &[f64]) -> Result<Vec<f32>> {
        let program =
            plan.asked().ok_or_else(|| Error::new(ErrorKind::Internal, "a plan for points has no program"))?;
        let window = plan.window;
        let (solutions, grids) = self.before_points(plan)?;
        let mut out = vec![0.0; window.len().saturating_mul(altitudes.len())];
        self.pool.install(|| {
            let rows = window.height.div_ceil(2 * parallel::threads()).clamp(8, BLOCK_HEIGHT);
            // Each band has its rows of every slice.
            let mut bands: Vec<Vec<&mut [f32]>> = (0..window.height.div_ceil(rows)).map(|_| Vec::new()).collect();
            for slice in out.chunks_mut(window.len()) {
                for (band, samples) in bands.iter_mut().zip(slice.chunks_mut(rows * window.width)) {
                    band.push(samples);
                }
            }
            self.bound(&self.evaluators(program), &solutions, &grids, |bindings| {
                parallel::try_for_each_init(
                    bands.into_iter().enumerate(),
                    || Interpreter::new(program),
                    |interpreter, (band, mut slices)| {
                        self.progress.check()?;
                        let top = band * rows;
                        for left in (0..window.width).step_by(BLOCK_WIDTH) {
                            let block = Window {
                                x: window.x + left as i64,
                                y: window.y + top as i64,
                                width: BLOCK_WIDTH.min(window.width - left),
                                height: rows.min(window.height - top),
                                cell: window.cell,
                            };
                            interpreter.run_block_at(&block, altitudes, bindings, |k, made| {
                                put(made, &block, slices[k], window.width, (left, 0));
                            })?;
                        }
                        Ok::<(), Error>(())
                    },
                )
            })
        })?;
        Ok(out)
    }
}
