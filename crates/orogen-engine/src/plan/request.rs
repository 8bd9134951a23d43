//! Requests of programs and filters for grids that earlier steps must make.

use super::resolved::ResolvedRecipe;
use crate::recipe::graph::{LayerRef, Link};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;
use orogen_ops::ids::{GridId, Id, IndexVec, NodeId, RequestId};
use orogen_ops::op::Op;
use std::collections::HashMap;

/// A request for a grid that an earlier step must make: a node's layer over a window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GridRequest {
    /// The layer.
    pub target: LayerRef,
    /// Whether the filter's own result is requested, before its mask; otherwise the node's result.
    pub raw: bool,
    /// The window.
    pub window: Window,
}

impl GridRequest {
    /// A request for a node's result. A filter or a levelled op without a mask makes it itself.
    pub fn of(resolved: &ResolvedRecipe, target: LayerRef, window: Window) -> GridRequest {
        let op = resolved.recipe.nodes()[target.node.index()].node.op();
        let raw = matches!(op, Op::Filter(_) | Op::Levelled(_)) && resolved.graph.masks[target.node] == Link::None;
        GridRequest { target, raw, window }
    }
}

/// All requests of a plan, and the grids that serve them.
#[derive(Debug, Default)]
pub struct Requests {
    requests: IndexVec<RequestId, GridRequest>,
    grids: IndexVec<RequestId, Option<GridId>>,
    by_node: HashMap<NodeId, Vec<RequestId>>,
}

impl Requests {
    /// Adds a request.
    pub fn add(&mut self, request: GridRequest) -> RequestId {
        let id = self.requests.push(request);
        self.grids.push(None);
        self.by_node.entry(request.target.node).or_default().push(id);
        id
    }

    /// Adds a request that is served by this grid instead of a node.
    pub fn add_served(&mut self, request: GridRequest, grid: GridId) -> RequestId {
        self.grids.push(Some(grid));
        self.requests.push(request)
    }

    /// A request.
    pub fn get(&self, id: RequestId) -> &GridRequest {
        &self.requests[id]
    }

    /// The requests for a node's own layers, before its mask (`raw`), or for its result.
    pub fn of(&self, node: NodeId, raw: bool) -> impl Iterator<Item = RequestId> + '_ {
        self.by_node.get(&node).into_iter().flatten().copied().filter(move |id| self.requests[*id].raw == raw)
    }

    /// Serves a request with a grid.
    pub fn serve(&mut self, id: RequestId, grid: GridId) {
        self.grids[id] = Some(grid);
    }

    /// The grid that serves a request.
    ///
    /// # Errors
    /// If there is none, which is a bug.
    pub fn grid(&self, id: RequestId) -> Result<GridId> {
        self.grids[id].ok_or_else(|| Error::new(ErrorKind::Internal, "no step makes a grid that is read"))
    }
}
