//! The roads of a world as lines.

use super::world::World;
use crate::node::Node;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::progress::Progress;
use orogen_grid::roads::RoadLine;
use orogen_ops::ids::{Id, NodeId};

/// A road of a node.
#[doc(hidden)]
#[derive(Debug, Clone, PartialEq)]
pub struct WorldRoad {
    /// The name of the node.
    pub node: String,
    /// The node's maximum grade.
    pub grade: f64,
    /// The line.
    pub line: RoadLine,
}

impl World {
    /// Whether the recipe has a node `roads`.
    #[doc(hidden)]
    #[must_use]
    pub fn has_roads(&self) -> bool {
        self.recipe().nodes().iter().any(|named| matches!(named.node, Node::Roads(_)))
    }

    /// The roads of all nodes `roads`, in the order of the recipe.
    ///
    /// # Errors
    /// If the recipe has no such node, memory does not suffice, roads cannot be built, or the work was cancelled.
    #[doc(hidden)]
    pub fn roads(&self, progress: &Progress) -> Result<Vec<WorldRoad>> {
        let nodes: Vec<(NodeId, &str, f64)> = (self.recipe().nodes().iter().enumerate())
            .filter_map(|(index, named)| match &named.node {
                Node::Roads(roads) => Some((NodeId::new(index), named.name.as_str(), roads.grade)),
                _ => None,
            })
            .collect();
        if nodes.is_empty() {
            let message = "the recipe has no roads; add a node with `op = \"roads\"`";
            return Err(Error::new(ErrorKind::Request, message));
        }
        let ids: Vec<NodeId> = nodes.iter().map(|(node, ..)| *node).collect();
        let plan = self.plan_to_solve(&ids)?;
        let _running = self.admit(&plan, progress)?;
        let solutions = self.engine(progress).solve(&plan)?;
        progress.finish();
        let mut roads = Vec::new();
        for (node, name, grade) in nodes {
            let Some(solution) = solutions.get(&node) else {
                return Err(Error::new(ErrorKind::Internal, "a node `roads` was not solved"));
            };
            let lines = RoadLine::from_numbers(&solution.scalars).into_iter();
            roads.extend(lines.map(|line| WorldRoad { node: name.to_owned(), grade, line }));
        }
        Ok(roads)
    }
}
