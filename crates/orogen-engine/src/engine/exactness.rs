//! Exactness: which grids of a plan have the processor's bits, and which must have them.

use super::preview::Preview;
use crate::plan::levels::{self, Serving};
use crate::plan::resolved::ResolvedRecipe;
use crate::plan::steps::{Plan, Step, wanted};
use orogen_ops::ids::{GridId, IndexVec};
use orogen_ops::op::Op;

/// Which grids of a plan have the processor's bits, and which must have them.
pub struct Exactness<'a> {
    preview: Option<&'a Preview<'a>>,
    /// Grids that must be exact: inputs of tiles of levels, which are kept, and of ops that only the processor
    /// computes.
    required: IndexVec<GridId, bool>,
    /// Grids that a device made, and grids computed from them.
    approximate: IndexVec<GridId, bool>,
}

impl<'a> Exactness<'a> {
    /// The exactness of a plan's grids before its first step.
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

    /// Whether everything that a step reads has the processor's bits.
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

/// The grids that must be exact for a levelled op: none if an input is approximate anyway. Otherwise its tiles are
/// exact. If the op is made on the device, only the levels below the tiled ones are approximate.
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
