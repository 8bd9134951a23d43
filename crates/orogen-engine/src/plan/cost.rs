//! How long a plan takes, about.
//!
//! The figures are nanoseconds of one core and were measured once: each op alone over 1024 x 1024 samples at 10 m, on its lattice
//! and behind a warp, on an AMD EPYC with AVX-512, what an empty program takes subtracted. Machines differ by a factor of three
//! or so either way, and noise of short wavelengths takes longer than what was measured: an estimate tells seconds from hours, not
//! more. There it was within a third of what the presets took at 4096 samples a side.

use super::program::{Instruction, Program};
use super::steps::{Plan, Solve, Step};
use crate::op::Op;
use crate::recipe::document::Recipe;

/// Storing a sample of a program's result.
const STORED: f64 = 0.2;
/// A sample of a grid or solution on its own lattice.
const COPIED: f64 = 0.3;
/// A sample between a grid's own.
const BETWEEN: f64 = 25.0;
/// A position moved.
const MOVED: f64 = 3.0;
/// A sample of a mask.
const MASKED: f64 = 0.5;

/// Nanoseconds of one core that a plan's steps take.
pub fn steps(plan: &Plan, recipe: &Recipe) -> f64 {
    plan.steps.iter().map(|one| step(one, plan, recipe)).sum()
}

/// Nanoseconds of one core that a step takes.
pub fn step(step: &Step, plan: &Plan, recipe: &Recipe) -> f64 {
    let sample = match step {
        Step::Fill { program, out, .. } => program_cost(program, plan.scattered && out.is_empty(), recipe),
        Step::Apply { node, window, .. } => match recipe.nodes()[*node].node.op() {
            Op::Filter(filter) => filter.cost(window.cell),
            _ => 0.0,
        },
    };
    sample * step.window().len() as f64
}

/// Nanoseconds of one core that a plan takes with nothing solved before.
pub fn needed(plan: &Plan, recipe: &Recipe) -> f64 {
    plan.solves.iter().map(Solve::work).sum::<f64>() + steps(plan, recipe)
}

/// Nanoseconds a sample.
fn program_cost(program: &Program, scattered: bool, recipe: &Recipe) -> f64 {
    let mut moved = vec![false; program.coord_sets.max(1)];
    moved[0] = scattered;
    let mut sum = STORED * program.outputs.len() as f64;
    for instruction in &program.instructions {
        sum += match instruction {
            Instruction::Constant { .. } => 0.05,
            Instruction::Apply { function, .. } => function.cost(),
            Instruction::Field { node, coords, inputs, .. } => match recipe.nodes()[*node].node.op() {
                Op::Field(field) if inputs.is_empty() && !moved[*coords] => field.cost_in_rows(),
                Op::Field(field) => field.cost(),
                _ => 0.0,
            },
            Instruction::Solved { node, coords, .. } => match recipe.nodes()[*node].node.op() {
                Op::Solver(solver) if solver.rasters() == 0 => COPIED,
                _ if moved[*coords] => BETWEEN,
                _ => BETWEEN / 4.0,
            },
            Instruction::Grid { coords: 0, .. } if !scattered => COPIED,
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
