//! Which grids of a plan have the bits of the processor, and which must have them.

use crate::ids::{GridId, IndexVec};
use crate::plan::steps::{Plan, Step};

/// Which grids have the bits of the processor, and which must have them.
pub struct Exactness {
    /// What levelled ops read, because their tiles are kept.
    required: IndexVec<GridId, bool>,
    /// What a device made, and what was made from that.
    approximate: IndexVec<GridId, bool>,
}

impl Exactness {
    /// That of a plan before its first step.
    pub fn of(plan: &Plan) -> Exactness {
        let none = || -> IndexVec<GridId, bool> { vec![false; plan.grids.len()].into() };
        let mut required = none();
        for (_, step) in plan.steps.entries().rev() {
            if matches!(step, Step::Refine { .. }) || step.writes().iter().any(|grid| required[*grid]) {
                step.reads().into_iter().for_each(|grid| required[grid] = true);
            }
        }
        Exactness { required, approximate: none() }
    }

    /// Whether a step's grids must have the bits of the processor.
    pub fn is_required(&self, step: &Step) -> bool {
        step.writes().iter().any(|grid| self.required[*grid])
    }

    /// Whether all that a step reads has them.
    pub fn is_read_by(&self, step: &Step) -> bool {
        !step.reads().iter().any(|grid| self.approximate[*grid])
    }

    /// Marks the grids of a step that was run, on a device or not.
    pub fn ran(&mut self, step: &Step, on_device: bool) {
        let approximate = on_device || !self.is_read_by(step);
        step.writes().into_iter().for_each(|grid| self.approximate[grid] = approximate);
    }
}
