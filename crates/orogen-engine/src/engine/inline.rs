//! A program on the calling thread alone, into samples that the caller holds: no pool, no grid, and no memory asked for once
//! the buffers have grown to their size.

use super::interpreter::{Bindings, Buffers, Interpreter};
use super::run::{Engine, Solutions};
use crate::plan::program::{BLOCK_HEIGHT, BLOCK_WIDTH, Program};
use crate::plan::steps::Plan;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};

/// A program for points with all that it reads made.
pub struct PreparedProgram {
    program: Program,
    solutions: Solutions,
    grids: Vec<Option<Grid>>,
    anywhere: bool,
}

impl PreparedProgram {
    /// Whether it answers for every point and every window, not just for points within the window it was planned for.
    pub fn anywhere(&self) -> bool {
        self.anywhere
    }
}

impl Engine<'_> {
    /// Makes all that a plan for points needs before it is asked; `None` if the plan is for no points.
    pub fn ready(&self, plan: &Plan) -> Result<Option<PreparedProgram>> {
        let Some(program) = plan.asked() else { return Ok(None) };
        let (solutions, grids) = self.before_points(plan)?;
        Ok(Some(PreparedProgram { program: program.clone(), solutions, grids, anywhere: plan.is_pointwise() }))
    }

    /// Makes the samples of a window, row-major, into `out`, which must have its length; gives the buffers back. Only for what
    /// answers [anywhere](PreparedProgram::anywhere).
    pub fn fill_inline(
        &self,
        ready: &PreparedProgram,
        window: &Window,
        buffers: Buffers,
        out: &mut [f32],
    ) -> Result<Buffers> {
        self.inline(ready, buffers, |interpreter, bindings| {
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
                    interpreter.run_block(&block, bindings)?;
                    let made = interpreter.output(0).chunks(block.width);
                    for (row, made) in out.chunks_mut(window.width).skip(top).zip(made) {
                        row[left..left + block.width].copy_from_slice(made);
                    }
                }
            }
            Ok(())
        })
    }

    /// Makes the values at points into `out`, which must have as many; gives the buffers back.
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
        let fields = |node| self.field(node);
        let solvers = |node| self.solver(node, &ready.solutions);
        let bindings =
            Bindings { world_params: self.world_params, fields: &fields, solvers: &solvers, grids: &ready.grids };
        let mut interpreter = Interpreter::with(&ready.program, buffers);
        work(&mut interpreter, &bindings)?;
        Ok(interpreter.into_buffers())
    }
}

/// Columns and rows of the blocks that a window so wide is cut into: about [`BLOCK_WIDTH`] columns, so that a chunk with its
/// far edge (257 samples) is not cut into a block and a sliver, and no more samples than a block has.
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
