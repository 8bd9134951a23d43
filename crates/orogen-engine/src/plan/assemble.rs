//! The last pass: from a schedule to a plan, in the order of execution, with grids in place of requests.

use super::schedule::{Asked, Schedule};
use super::steps::{GridSlot, Plan, Step};
use orogen_grid::error::Result;
use orogen_ops::ids::{Id, IndexVec, StepId};

/// The plan of a schedule, without solvers.
///
/// # Errors
/// If a step reads a grid that none makes, which is a bug.
pub fn assemble(schedule: Schedule, asked: &Asked) -> Result<Plan> {
    let Schedule { steps, requests, grids, outputs, .. } = schedule;
    let steps = steps.into_iter().rev().map(|step| step.resolve(|request| requests.grid(request)));
    let steps: IndexVec<StepId, Step> = steps.collect::<Result<Vec<Step>>>()?.into();
    let mut grids: IndexVec<_, GridSlot> = grids
        .iter()
        .map(|grid| GridSlot { window: grid.window, node: grid.node, last_use: Some(StepId::new(0)) })
        .collect();
    for (at, step) in steps.entries() {
        for grid in step.reads().into_iter().chain(step.writes()) {
            grids[grid].last_use = Some(at);
        }
    }
    outputs.iter().for_each(|output| grids[*output].last_use = None);
    let Asked { window, scattered, .. } = *asked;
    Ok(Plan { recipe: [0; 32], window, scattered, solves: Vec::new(), steps, grids, outputs })
}
