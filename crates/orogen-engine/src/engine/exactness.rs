//! Which grids of a plan have the bits of the processor, and which must have them.

use super::preview::Preview;
use crate::plan::levels::{self, Serving};
use crate::plan::resolved::ResolvedRecipe;
use crate::plan::steps::{Plan, Step, wanted};
use orogen_ops::ids::{GridId, IndexVec};
use orogen_ops::op::Op;

/// Which grids have the bits of the processor, and which must have them.
pub struct Exactness<'a> {
    preview: Option<&'a Preview<'a>>,
    /// What tiles of levels are made from, because they are kept, and what is made on the processor alone.
    required: IndexVec<GridId, bool>,
    /// What a device made, and what was made from that.
    approximate: IndexVec<GridId, bool>,
}

impl<'a> Exactness<'a> {
    /// That of a plan before its first step.
    pub fn of(resolved: &ResolvedRecipe, preview: Option<&'a Preview<'a>>, plan: &Plan) -> Exactness<'a> {
        let none = || -> IndexVec<GridId, bool> { vec![false; plan.grids.len()].into() };
        let mut required = none();
        for (_, step) in plan.steps.entries().rev() {
            if step.writes().iter().any(|grid| required[*grid]) {
                step.reads().into_iter().for_each(|grid| required[grid] = true);
            }
            exact_inputs(resolved, preview, step).into_iter().for_each(|grid| required[grid] = true);
        }
        Exactness { preview, required, approximate: none() }
    }

    /// Whether a step's grids must have the bits of the processor.
    pub fn is_required(&self, step: &Step) -> bool {
        step.writes().iter().any(|grid| self.required[*grid])
    }

    /// Whether all that a step reads has them.
    pub fn is_read_by(&self, step: &Step) -> bool {
        let Some(preview) = self.preview else { return true };
        let reads_solution = step.solvers_read().any(|node| preview.is_approximate(node));
        !reads_solution && !step.reads().iter().any(|grid| self.approximate[*grid])
    }

    /// Marks the grids of a step that was run, on a device or not. Returns whether they have the bits of the processor.
    pub fn ran(&mut self, step: &Step, on_device: bool) -> bool {
        let levels = match (step, self.preview) {
            (Step::Refine { node, .. }, Some(preview)) => preview.is_approximate(*node),
            _ => false,
        };
        let approximate = on_device || levels || !self.is_read_by(step);
        step.writes().into_iter().for_each(|grid| self.approximate[grid] = approximate);
        !approximate
    }

    /// Marks the grids of a step that were kept from an earlier preview.
    pub fn found(&mut self, step: &Step) {
        step.writes().into_iter().for_each(|grid| self.approximate[grid] = true);
    }
}

/// The grids that must be exact for a levelled op: none if it reads what the device makes anyway. Otherwise its tiles
/// are exact; if it is made on the device, that begins below the tiled levels.
fn exact_inputs(resolved: &ResolvedRecipe, preview: Option<&Preview>, step: &Step) -> Vec<GridId> {
    let Step::Refine { node, inputs, window, out } = step else { return Vec::new() };
    let exact = match (preview, resolved.op(*node)) {
        (Some(preview), _) if preview.is_read_by(*node) => 0,
        (Some(preview), Some(Op::Levelled(op))) if preview.is_approximate(*node) => {
            1 + levels::tiled(op, &wanted(out), &Serving::of(&op.levels(), window))
        }
        _ => inputs.len(),
    };
    inputs.iter().take(exact).flatten().flatten().copied().collect()
}
