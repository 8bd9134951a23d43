//! Memory of a plan, known before the first sample.

use super::steps::{Plan, Solve, Step, grid_bytes, wanted};
use super::{levels, parts};
use crate::recipe::document::Recipe;
use orogen_io::pages;
use orogen_ops::ids::{GridId, Id, IndexVec, StepId};
use orogen_ops::op::Op;
use orogen_ops::program::{BLOCK_HEIGHT, BLOCK_WIDTH, Program};

/// Memory of the registers and coordinate sets of one thread.
fn block_bytes(program: &Program) -> u64 {
    let block = (BLOCK_WIDTH * BLOCK_HEIGHT) as u64;
    // A coordinate set may hold two f64 per sample.
    block * 4 * program.registers as u64 + block * 16 * program.coord_sets as u64
}

/// Maximum memory of all grids at any step.
pub fn grids(plan: &Plan) -> u64 {
    let mut born: IndexVec<GridId, Option<StepId>> = vec![None; plan.grids.len()].into();
    for (at, step) in plan.steps.entries() {
        for grid in step.writes() {
            born[grid] = Some(at);
        }
    }
    // Grids are created at a step and dropped after one: sum the changes instead of all grids at all steps.
    let mut change = vec![(0u64, 0u64); plan.steps.len() + 2];
    for (grid, born) in plan.grids.iter().zip(born.iter()) {
        if let Some(born) = born {
            let bytes = grid_bytes(&grid.window);
            let more = &mut change[born.index()].0;
            *more = more.saturating_add(bytes);
            let less = &mut change[grid.last_use.map_or(plan.steps.len(), StepId::index) + 1].1;
            *less = less.saturating_add(bytes);
        }
    }
    let (mut now, mut most) = (0u64, 0u64);
    for (more, less) in change {
        now = now.saturating_sub(less).saturating_add(more);
        most = most.max(now);
    }
    most
}

/// Memory of the steps in addition to the grids: registers of each thread, or a filter's own memory.
fn beside(plan: &Plan, recipe: &Recipe, threads: usize) -> u64 {
    let step = |step: &Step| match step {
        Step::Fill { program, .. } => block_bytes(program).saturating_mul(threads as u64),
        Step::Apply { node, inputs, window, halo, .. } => {
            // A grid that was made for other steps too is cropped for the filter.
            let cut = |slot: &GridId| plan.grids[*slot].window != window.grown(*halo);
            let cuts = inputs.iter().flatten().filter(|slot| cut(slot)).count() as u64;
            let own = match recipe.nodes()[node.index()].node.op() {
                Op::Filter(filter) => filter.scratch(window),
                _ => 0,
            };
            grid_bytes(&window.grown(*halo)).saturating_mul(cuts).saturating_add(own)
        }
        Step::Refine { node, window, out, .. } => match recipe.nodes()[node.index()].node.op() {
            Op::Levelled(op) => levels::memory(op, &wanted(out), window, threads),
            _ => 0,
        },
    };
    plan.steps.iter().map(step).max().unwrap_or(0)
}

/// Maximum memory of a plan's steps after all solvers are solved, in bytes; also the memory for a tile of a solver's
/// sources.
pub fn steps(plan: &Plan, recipe: &Recipe, threads: usize) -> u64 {
    grids(plan).saturating_add(beside(plan, recipe, threads))
}

/// Memory of a solver's rasters, in bytes.
pub fn rasters(solve: &Solve) -> u64 {
    let one = if solve.on_disk { pages::memory(&solve.padded) } else { grid_bytes(&solve.padded) };
    one.saturating_mul(solve.rasters as u64)
}

/// Memory for solving in addition to the rasters, in bytes.
fn scratch(solve: &Solve) -> u64 {
    if solve.on_disk { solve.scratch_on_disk } else { solve.scratch }
}

/// Maximum memory of a plan on `threads` threads, in bytes: its own size, the files that the recipe names, the windows
/// that are read of large files, grids, registers, solutions, and the computation of solvers' sources.
pub fn needed(plan: &Plan, recipe: &Recipe, threads: usize) -> u64 {
    let solving = plan.solves.iter().map(|solve| solve.tile.saturating_add(scratch(solve))).max().unwrap_or(0);
    let kept = plan.solves.iter().fold(0u64, |sum, solve| sum.saturating_add(rasters(solve)));
    let own = plan.steps.iter().map(own_bytes).sum::<u64>();
    let files = recipe.held().saturating_add(parts::memory(plan, recipe));
    own.saturating_add(files).saturating_add(kept).saturating_add(steps(plan, recipe, threads).max(solving))
}

/// Size of a step as a value, in bytes.
fn own_bytes(step: &Step) -> u64 {
    match step {
        Step::Fill { program, .. } => 128 * program.instructions.len() as u64,
        Step::Apply { .. } | Step::Refine { .. } => 128,
    }
}

/// Maximum disk space for data that does not fit in memory, in bytes.
pub fn disk(plan: &Plan) -> u64 {
    let on_disk = plan.solves.iter().filter(|solve| solve.on_disk);
    on_disk.fold(0u64, |sum, solve| sum.saturating_add(pages::disk(&solve.padded).saturating_mul(solve.rasters as u64)))
}

/// Moves rasters to disk, the largest first, until the plan fits in `allowed` bytes or none are left. Returns whether
/// it fits.
pub fn fit(plan: &mut Plan, recipe: &Recipe, threads: usize, allowed: u64) -> bool {
    while needed(plan, recipe, threads) > allowed {
        let bytes = |solve: &Solve| rasters(solve).saturating_add(scratch(solve));
        let gain = |solve: &Solve| bytes(solve).saturating_sub(bytes(&Solve { on_disk: true, ..solve.clone() }));
        let movable = plan.solves.iter_mut().filter(|solve| !solve.on_disk && gain(solve) > 0);
        match movable.max_by_key(|solve| gain(solve)) {
            Some(solve) => solve.on_disk = true,
            None => return false,
        }
    }
    true
}
