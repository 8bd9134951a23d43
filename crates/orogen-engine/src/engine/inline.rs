//! Running a program on the calling thread into the caller's samples: without the pool, without grids, and without
//! allocation once the buffers have their final size.

use super::grids::Grids;
use super::run::{Engine, Solutions};
use crate::plan::steps::Plan;
use orogen_grid::error::Result;
use orogen_grid::grid::Window;
use orogen_ops::interpreter::{Bindings, Buffers, Evaluators, Interpreter};
use orogen_ops::program::{BLOCK_HEIGHT, BLOCK_WIDTH, Program};

/// A program for points, with its fields prepared and all its inputs computed.
pub struct PreparedProgram {
    program: Program,
    evaluators: Evaluators,
    solutions: Solutions,
    grids: Grids,
    anywhere: bool,
}

impl PreparedProgram {
    /// Whether it is valid for every point and every window, not only for the window it was planned for.
    pub fn anywhere(&self) -> bool {
        self.anywhere
    }
}

impl Engine<'_> {
    /// Computes everything that a plan for points needs before evaluation; `None` if the plan is not for points.
    pub fn ready(&self, plan: &Plan) -> Result<Option<PreparedProgram>> {
        let Some(program) = plan.asked() else { return Ok(None) };
        let (solutions, grids) = self.before_points(plan)?;
        let (evaluators, anywhere) = (self.evaluators(program), plan.is_pointwise());
        Ok(Some(PreparedProgram { program: program.clone(), evaluators, solutions, grids, anywhere }))
    }

    /// Computes the samples of a window, row-major, into `out`, which must have its length; returns the buffers. The
    /// program must be valid [anywhere](PreparedProgram::anywhere).
    pub fn fill_inline(
        &self,
        ready: &PreparedProgram,
        window: &Window,
        buffers: Buffers,
        out: &mut [f32],
    ) -> Result<Buffers> {
        self.inline(ready, buffers, |interpreter, bindings| {
            each_block(window, |left, top, block| {
                interpreter.run_block(block, bindings)?;
                put(interpreter.output(0), block, out, window.width, (left, top));
                Ok(())
            })
        })
    }

    /// Computes the samples of a window at each altitude into `out`, slice by slice, each row-major; returns the
    /// buffers. `out` must have as many elements as there are samples. The program must be valid for the window.
    pub fn volume_inline(
        &self,
        ready: &PreparedProgram,
        (window, altitudes): (&Window, &[f64]),
        buffers: Buffers,
        out: &mut [f32],
    ) -> Result<Buffers> {
        self.inline(ready, buffers, |interpreter, bindings| {
            each_block(window, |left, top, block| {
                interpreter.run_block_at(block, altitudes, bindings, |k, made| {
                    let slice = &mut out[k * window.len()..(k + 1) * window.len()];
                    put(made, block, slice, window.width, (left, top));
                })
            })
        })
    }

    /// Computes the values at points into `out`, which must have the same length; returns the buffers.
    pub fn points_inline(
        &self,
        ready: &PreparedProgram,
        (x, y): (&[f64], &[f64]),
        buffers: Buffers,
        out: &mut [f32],
    ) -> Result<Buffers> {
        self.inline(ready, buffers, |interpreter, bindings| {
            const POINTS: usize = BLOCK_WIDTH * BLOCK_HEIGHT;
            for ((x, y), out) in x.chunks(POINTS).zip(y.chunks(POINTS)).zip(out.chunks_mut(POINTS)) {
                interpreter.run_points(x, y, bindings)?;
                out.copy_from_slice(interpreter.output(0));
            }
            Ok(())
        })
    }

    fn inline(
        &self,
        ready: &PreparedProgram,
        buffers: Buffers,
        work: impl FnOnce(&mut Interpreter, &Bindings) -> Result<()>,
    ) -> Result<Buffers> {
        let mut interpreter = Interpreter::with(&ready.program, buffers);
        let PreparedProgram { evaluators, solutions, grids, .. } = ready;
        self.bound(evaluators, solutions, grids, |bindings| work(&mut interpreter, bindings))?;
        Ok(interpreter.into_buffers())
    }
}

/// Visits the blocks of a window, each with its first column and row in the window.
fn each_block(window: &Window, mut visit: impl FnMut(usize, usize, &Window) -> Result<()>) -> Result<()> {
    let (columns, rows) = block(window.width);
    for top in (0..window.height).step_by(rows) {
        for left in (0..window.width).step_by(columns) {
            let block = Window {
                x: window.x + left as i64,
                y: window.y + top as i64,
                width: columns.min(window.width - left),
                height: rows.min(window.height - top),
                cell: window.cell,
            };
            visit(left, top, &block)?;
        }
    }
    Ok(())
}

/// Copies the samples of a block into rows of `width` samples, from a column and a row on.
pub(super) fn put(made: &[f32], block: &Window, out: &mut [f32], width: usize, (left, top): (usize, usize)) {
    for (row, made) in out.chunks_mut(width).skip(top).zip(made.chunks(block.width)) {
        row[left..left + block.width].copy_from_slice(made);
    }
}

/// Columns and rows of the blocks of a window with this width: about [`BLOCK_WIDTH`] columns, so that a chunk including
/// its far edge (257 samples) is not split into a block and a sliver, and at most the samples of a block.
fn block(width: usize) -> (usize, usize) {
    let across = ((width + BLOCK_WIDTH / 2) / BLOCK_WIDTH).max(1);
    let columns = width.div_ceil(across).max(1);
    (columns, (BLOCK_WIDTH * BLOCK_HEIGHT / columns).max(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_about_as_wide_as_meant_and_never_larger() {
        for (width, expect) in [(1, (1, 16384)), (256, (256, 64)), (257, (257, 63)), (383, (383, 42)), (384, (192, 85))]
        {
            assert_eq!(block(width), expect, "{width}");
        }
        for width in 1..2000 {
            let (columns, rows) = block(width);
            assert!(columns * rows <= BLOCK_WIDTH * BLOCK_HEIGHT, "{width}");
            assert!(columns <= width && width.div_ceil(columns) * 128 <= width.max(128) + 127, "{width}: {columns}");
        }
    }
}
