//! Resolved recipes: everything that is known about a recipe before any request.

use super::key::{Key, identity, keys};
use crate::recipe::document::Recipe;
use crate::recipe::graph::{Graph, Link};
use orogen_ops::ids::{Id, IndexVec, NodeId};
use orogen_ops::op::{Op, WorldParams};

/// A valid recipe with its graph and the content keys of its nodes.
pub struct ResolvedRecipe {
    pub recipe: Recipe,
    pub graph: Graph,
    pub world_params: WorldParams,
    /// The content keys of the nodes.
    pub keys: IndexVec<NodeId, Key>,
    /// The identity of the recipe, which plans contain.
    pub identity: Key,
}

impl ResolvedRecipe {
    /// A recipe and its graph.
    pub fn new(recipe: Recipe, graph: Graph) -> ResolvedRecipe {
        let (world_params, keys) = (recipe.world.world_params(), keys(&recipe, &graph));
        let identity = identity(&keys);
        ResolvedRecipe { recipe, graph, world_params, keys, identity }
    }

    /// The op of a node.
    pub fn op(&self, node: NodeId) -> Option<Op<'_>> {
        Some(self.recipe.nodes().get(node.index())?.node.op())
    }

    /// Whether each input of a node is given.
    pub fn given(&self, node: NodeId) -> Vec<bool> {
        self.graph.links[node].iter().map(|link| *link != Link::None).collect()
    }
}
