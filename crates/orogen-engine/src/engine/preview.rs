//! Previews: results that a device computes, kept apart from the processor's results.

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

/// A device, and the nodes of a recipe whose results it makes approximate.
pub struct Preview<'a> {
    pub device: &'a dyn Device,
    pub kept: &'a Kept,
    /// Whether the device also runs chaotic solvers.
    is_draft: bool,
    /// Solvers and levelled ops that the device computes, and all nodes that depend on them. Fields and filters that it
    /// computes are not marked: whether they must be exact depends on the nodes that read them.
    approximate: IndexVec<NodeId, bool>,
    /// Whether each node reads an approximate node.
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

    /// The passes by which the device runs a solver; `None` if the processor runs it.
    pub fn passes_of(&self, resolved: &ResolvedRecipe, node: NodeId, solver: &dyn Solver) -> Option<Passes> {
        let passes = lowered(resolved, node, solver)?;
        (self.is_draft || !passes.is_chaotic).then_some(passes)
    }

    /// Whether the device has lost grids that it had made.
    pub fn has_lost(&self) -> bool {
        self.has_lost.load(Ordering::Relaxed)
    }

    /// Records that the device has lost grids.
    pub fn lose(&self) {
        self.has_lost.store(true, Ordering::Relaxed);
    }

    /// Whether a node is computed on the device, or depends on a node that is.
    pub fn is_approximate(&self, node: NodeId) -> bool {
        self.approximate[node]
    }

    /// Whether a node depends on a node that is computed on the device.
    pub fn is_read_by(&self, node: NodeId) -> bool {
        self.reads[node]
    }
}

/// The passes by which a device runs a solver, chaotic or not.
fn lowered(resolved: &ResolvedRecipe, node: NodeId, solver: &dyn Solver) -> Option<Passes> {
    let padded = Domain::of(solver, &resolved.world_params).padded;
    solver.lower(&padded, &resolved.given(node), &resolved.world_params).shader()
}

/// Whether a solver that a plan has to solve is chaotic on a device: its terrain would differ from the processor's.
pub fn may_draft(resolved: &ResolvedRecipe, store: &Store, plan: &Plan) -> bool {
    let is_missing = |order: &&Solve| !store.has(&order.key);
    plan.solves.iter().filter(is_missing).any(|order| match resolved.op(order.node) {
        Some(Op::Solver(solver)) => lowered(resolved, order.node, solver).is_some_and(|passes| passes.is_chaotic),
        _ => false,
    })
}
