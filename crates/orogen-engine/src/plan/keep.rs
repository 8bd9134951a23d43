//! The choice of nodes whose results are kept as grids, instead of being evaluated by each program that reads them.

use crate::recipe::document::Recipe;
use orogen_ops::ids::{Id, NodeId};
use orogen_ops::op::Op;
use std::collections::{HashMap, HashSet};

/// The nodes that the programs of a plan evaluate at the block itself, where a grid could be read instead.
#[derive(Debug, Default)]
pub struct Evaluations {
    /// Nodes whose result is a grid anyway, because a filter reads it.
    filled: HashSet<NodeId>,
    /// Number of programs that evaluate each node.
    counts: HashMap<NodeId, usize>,
}

impl Evaluations {
    /// Records that a step makes a grid of a node's result.
    pub fn fill(&mut self, node: NodeId) {
        self.filled.insert(node);
    }

    /// Records the nodes that a program evaluates.
    pub fn add(&mut self, nodes: &[NodeId]) {
        for node in nodes {
            *self.counts.entry(*node).or_default() += 1;
        }
    }

    /// Nodes whose result is a grid anyway and that other programs evaluate again.
    pub fn of_grids(&self) -> HashSet<NodeId> {
        self.repeated().filter(|node| self.filled.contains(node)).collect()
    }

    /// Expensive fields that several programs evaluate.
    pub fn of_expensive_fields(&self, recipe: &Recipe) -> HashSet<NodeId> {
        /// Nanoseconds per sample.
        const EXPENSIVE: f64 = 1.0;
        let is_expensive = |node: &NodeId| match recipe.nodes()[node.index()].node.op() {
            Op::Field(field) => field.cost() >= EXPENSIVE,
            _ => false,
        };
        self.repeated().filter(is_expensive).collect()
    }

    fn repeated(&self) -> impl Iterator<Item = NodeId> + '_ {
        self.counts.iter().filter(|(_, count)| **count >= 2).map(|(node, _)| *node)
    }
}
