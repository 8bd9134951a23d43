//! The nodes of a recipe, as what runs them sees them.

use crate::recipe::document::Recipe;
use crate::recipe::graph::{Graph, Link};
use orogen_ops::ids::{Id, NodeId};
use orogen_ops::op::{Op, WorldParams};

/// The nodes of a recipe and what they read.
#[derive(Clone, Copy)]
pub struct Nodes<'a> {
    pub recipe: &'a Recipe,
    pub graph: &'a Graph,
    pub world_params: &'a WorldParams,
}

impl<'a> Nodes<'a> {
    /// A node as what it is.
    pub fn op(&self, node: NodeId) -> Option<Op<'a>> {
        Some(self.recipe.nodes().get(node.index())?.node.op())
    }

    /// Whether each input of a node is given.
    pub fn given(&self, node: NodeId) -> Vec<bool> {
        self.graph.links[node].iter().map(|link| *link != Link::None).collect()
    }
}
