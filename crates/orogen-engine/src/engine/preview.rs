//! Previews: what a device computes, kept apart from what the processor computes.

use crate::device::Device;
use crate::plan::domain::Domain;
use crate::plan::resolved::ResolvedRecipe;
use crate::plan::steps::{Plan, Solve};
use crate::recipe::graph::Link;
use crate::store::kept::Kept;
use crate::store::solutions::Store;
use orogen_ops::ids::{IndexVec, NodeId};
use orogen_ops::lower::Passes;
use orogen_ops::op::{Op, Solver};
use std::sync::atomic::{AtomicBool, Ordering};

/// A device, and which nodes of a recipe are approximate with it.
pub struct Preview<'a> {
    pub device: &'a dyn Device,
    pub kept: &'a Kept,
    /// Whether the device also solves what is chaotic.
    is_draft: bool,
    /// Solvers and levelled ops that the device computes, and all that reads them. Fields and filters that it computes
    /// are not among them: whether they must be exact depends on who reads them.
    approximate: IndexVec<NodeId, bool>,
    /// Whether a node reads such a node.
    reads: IndexVec<NodeId, bool>,
    /// Whether the device has lost grids.
    has_lost: AtomicBool,
}

impl<'a> Preview<'a> {
    /// A preview of a recipe. With `is_draft` the device also runs chaotic solvers, whose terrain differs.
    pub fn new(device: &'a dyn Device, kept: &'a Kept, resolved: &ResolvedRecipe, is_draft: bool) -> Preview<'a> {
        let none = || -> IndexVec<NodeId, bool> { vec![false; resolved.recipe.nodes().len()].into() };
        let (approximate, reads, has_lost) = (none(), none(), AtomicBool::new(false));
        let mut preview = Preview { device, kept, is_draft, approximate, reads, has_lost };
        for &node in &resolved.graph.order {
            let is_approximate = |link: &Link| matches!(link, Link::Node(read) if preview.approximate[read.node]);
            let mut links = resolved.graph.links[node].iter().chain([&resolved.graph.masks[node]]);
            preview.reads[node] = links.any(is_approximate);
            preview.approximate[node] = preview.reads[node] || preview.makes(resolved, node);
        }
        preview
    }

    /// Whether the device computes a solver, or a level of a levelled op.
    fn makes(&self, resolved: &ResolvedRecipe, node: NodeId) -> bool {
        match resolved.op(node) {
            Some(Op::Solver(solver)) => self.passes_of(resolved, node, solver).is_some(),
            Some(Op::Levelled(op)) => {
                let given = resolved.given(node);
                let mut levels = 1..op.levels().count;
                levels.any(|level| op.lower(level, &given, &resolved.world_params).shader().is_some())
            }
            _ => false,
        }
    }

    /// How the device solves a solver; `None` if the processor does.
    pub fn passes_of(&self, resolved: &ResolvedRecipe, node: NodeId, solver: &dyn Solver) -> Option<Passes> {
        let passes = lowered(resolved, node, solver)?;
        (self.is_draft || !passes.is_chaotic).then_some(passes)
    }

    /// Whether the device has lost grids that it had made.
    pub fn has_lost(&self) -> bool {
        self.has_lost.load(Ordering::Relaxed)
    }

    /// Notes that it has.
    pub fn lose(&self) {
        self.has_lost.store(true, Ordering::Relaxed);
    }

    /// Whether a node is made on the device, or from what is made there.
    pub fn is_approximate(&self, node: NodeId) -> bool {
        self.approximate[node]
    }

    /// Whether a node is made from what is made on the device.
    pub fn is_read_by(&self, node: NodeId) -> bool {
        self.reads[node]
    }
}

/// How a device solves a solver, also if that is chaotic.
fn lowered(resolved: &ResolvedRecipe, node: NodeId, solver: &dyn Solver) -> Option<Passes> {
    let padded = Domain::of(solver, &resolved.world_params).padded;
    solver.lower(&padded, &resolved.given(node), &resolved.world_params).shader()
}

/// Whether a device would make other land than the processor of one of the solvers that a plan has to solve.
pub fn may_draft(resolved: &ResolvedRecipe, store: &Store, plan: &Plan) -> bool {
    let is_missing = |order: &&Solve| !store.has(&order.key);
    plan.solves.iter().filter(is_missing).any(|order| match resolved.op(order.node) {
        Some(Op::Solver(solver)) => lowered(resolved, order.node, solver).is_some_and(|passes| passes.is_chaotic),
        _ => false,
    })
}
