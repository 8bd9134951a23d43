//! How much memory a plan takes, known before the first sample.

use super::program::{BLOCK_HEIGHT, BLOCK_WIDTH, Program};
use super::steps::{Plan, Step};
use crate::grid::Window;
use crate::op::Op;
use crate::recipe::document::Recipe;

/// Bytes of one grid over a window.
pub fn grid_bytes(window: &Window) -> u64 {
    (window.width as u64).saturating_mul(window.height as u64).saturating_mul(4)
}

/// Registers and places of one thread.
fn block_bytes(program: &Program) -> u64 {
    let block = (BLOCK_WIDTH * BLOCK_HEIGHT) as u64;
    // A place may hold two f64 a sample.
    block * 4 * program.registers as u64 + block * 16 * program.places as u64
}

/// The most that grids take together at any step.
pub fn grids(plan: &Plan) -> u64 {
    let mut born = vec![usize::MAX; plan.grids.len()];
    for (at, step) in plan.steps.iter().enumerate() {
        for grid in step.writes() {
            born[grid] = at;
        }
    }
    // Grids are born at a step and die after one: sum the changes instead of all grids at all steps.
    let mut change = vec![(0u64, 0u64); plan.steps.len() + 2];
    for (grid, born) in plan.grids.iter().zip(&born) {
        if *born != usize::MAX {
            let bytes = grid_bytes(&grid.window);
            change[*born].0 = change[*born].0.saturating_add(bytes);
            let after = &mut change[grid.last_use.min(plan.steps.len()) + 1].1;
            *after = after.saturating_add(bytes);
        }
    }
    let (mut now, mut most) = (0u64, 0u64);
    for (more, less) in change {
        now = now.saturating_sub(less).saturating_add(more);
        most = most.max(now);
    }
    most
}

/// Bytes a plan needs at most at any time, for `threads` threads: grids, registers, solutions, and making solvers' sources.
pub fn needed(plan: &Plan, recipe: &Recipe, threads: usize) -> u64 {
    let mut beside = 0;
    for step in &plan.steps {
        beside = beside.max(match step {
            Step::Fill { program, .. } => block_bytes(program).saturating_mul(threads as u64),
            Step::Apply { node, window, .. } => match recipe.nodes()[*node].node.op() {
                Op::Filter(filter) => filter.scratch(window),
                _ => 0,
            },
        });
    }
    let steps = grids(plan).saturating_add(beside);
    let solving = plan.solves.iter().map(|solve| solve.tile.saturating_add(solve.scratch)).max().unwrap_or(0);
    let tiles = solving.saturating_add(beside);
    let kept = plan.solves.iter().fold(0u64, |sum, solve| sum.saturating_add(solve.kept));
    kept.saturating_add(steps.max(if plan.solves.is_empty() { 0 } else { tiles }))
}
