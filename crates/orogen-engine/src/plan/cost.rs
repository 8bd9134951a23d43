//! Estimates of a plan's time.
//!
//! Costs are in nanoseconds on one core. They were measured once, for each op alone over 1024 x 1024 samples at 10 m,
//! on its lattice and after a warp, on an AMD EPYC with AVX-512, minus the time of an empty program. Other machines
//! differ by a factor of up to about three, and noise of short wavelengths takes longer, so an estimate only
//! distinguishes seconds from hours. On that machine it was within a third of the time of the presets at 4096 samples
//! per side.

use super::levels;
use super::steps::{Plan, Solve, Step, wanted};
use crate::recipe::document::Recipe;
use orogen_ops::ids::{CoordSetId, GridId, Id, IndexVec};
use orogen_ops::op::Op;
use orogen_ops::program::{Instruction, Program};

/// Storing a sample of a program's result.
const STORED: f64 = 0.2;
/// A sample of a grid or solution on its own lattice.
const COPIED: f64 = 0.3;
/// An interpolated sample.
const BETWEEN: f64 = 25.0;
/// Moving a position.
const MOVED: f64 = 3.0;
/// Applying a mask to a sample.
const MASKED: f64 = 0.5;

/// Time of a plan's steps on one core, in nanoseconds.
pub fn steps(plan: &Plan, recipe: &Recipe) -> f64 {
    plan.steps.iter().map(|one| step(one, plan, recipe)).sum()
}

/// Time of a step on one core, in nanoseconds.
pub fn step(step: &Step, plan: &Plan, recipe: &Recipe) -> f64 {
    let sample = match step {
        Step::Fill { program, window, out } => {
            let on_lattice = |grid: &GridId| plan.grids[*grid].window.cell == window.cell;
            program_cost(program, plan.scattered && out.is_empty(), recipe, &on_lattice)
        }
        Step::Apply { node, window, halo, .. } => match recipe.nodes()[node.index()].node.op() {
            // Of the halo about half is computed: passes over it shrink.
            Op::Filter(filter) => return filter.cost(window.cell) * window.grown(halo / 2).len() as f64,
            _ => 0.0,
        },
        Step::Refine { node, window, out, .. } => match recipe.nodes()[node.index()].node.op() {
            Op::Levelled(op) => return levels::cost(op, &wanted(out), window),
            _ => 0.0,
        },
    };
    sample * step.window().len() as f64
}

/// Time of a plan without stored solutions on one core, in nanoseconds.
pub fn needed(plan: &Plan, recipe: &Recipe) -> f64 {
    plan.solves.iter().map(Solve::work).sum::<f64>() + steps(plan, recipe)
}

/// Time of a program for a sample of its own lattice on one core, in nanoseconds.
pub fn program(program: &Program, recipe: &Recipe) -> f64 {
    program_cost(program, false, recipe, &|_| true)
}

/// Nanoseconds per sample.
fn program_cost(program: &Program, scattered: bool, recipe: &Recipe, on_lattice: &dyn Fn(&GridId) -> bool) -> f64 {
    let mut moved: IndexVec<CoordSetId, bool> = vec![false; program.coord_sets.max(1)].into();
    moved[CoordSetId::BLOCK] = scattered;
    let mut sum = STORED * program.outputs.len() as f64;
    for instruction in &program.instructions {
        sum += match instruction {
            Instruction::Constant { .. } => 0.05,
            Instruction::Apply { function, .. } => function.cost(),
            Instruction::Field { node, coords, inputs, .. } => match recipe.nodes()[node.index()].node.op() {
                Op::Field(field) if inputs.is_empty() && !moved[*coords] => field.cost_in_rows(),
                Op::Field(field) => field.cost(),
                _ => 0.0,
            },
            Instruction::Solved { node, coords, .. } => match recipe.nodes()[node.index()].node.op() {
                Op::Solver(solver) if solver.rasters() == 0 => COPIED,
                _ if moved[*coords] => BETWEEN,
                _ => BETWEEN / 4.0,
            },
            Instruction::Grid { grid, coords: CoordSetId::BLOCK, .. } if !scattered && on_lattice(grid) => COPIED,
            Instruction::Grid { coords, .. } if !moved[*coords] => BETWEEN / 4.0,
            Instruction::Grid { .. } => BETWEEN,
            Instruction::Mask { .. } => MASKED,
            Instruction::Displace { to, .. } => {
                moved[*to] = true;
                MOVED
            }
            Instruction::Map { from, map, to } => {
                moved[*to] = moved[*from] || !map.is_separable();
                if moved[*to] { MOVED } else { 0.0 }
            }
        };
    }
    sum
}
