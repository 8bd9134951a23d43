//! Checks that the heights that a plan reads are available: a large file may have been read only in part.

use super::steps::{Plan, Step};
use crate::recipe::document::Recipe;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_ops::ids::{CoordSetId, Id, NodeId};
use orogen_ops::node::Node;
use orogen_ops::program::Instruction;

/// Checks that a plan uses only heights that have been read from their files. Solvers read the whole world, and points
/// may be anywhere in it, so they need whole files.
///
/// # Errors
/// [`ErrorKind::Part`] if it needs other heights.
pub fn check(plan: &Plan, recipe: &Recipe) -> Result<()> {
    let is_part =
        |node: &Node| matches!(node, Node::Dem(dem) if dem.path.ground().is_some_and(|ground| ground.is_part()));
    if !recipe.nodes().iter().any(|named| is_part(&named.node)) {
        return Ok(());
    }
    let held = plan.solves.is_empty() && !plan.scattered && plan.steps.iter().all(|step| holds(step, recipe));
    match held {
        true => Ok(()),
        false => Err(Error::new(
            ErrorKind::Part,
            "the heights of a file were read in part, and others are needed; read the whole file",
        )),
    }
}

fn holds(step: &Step, recipe: &Recipe) -> bool {
    let Step::Fill { program, window, .. } = step else { return true };
    program.instructions.iter().all(|instruction| match instruction {
        Instruction::Field { node, coords, .. } => match &node_of(recipe, *node) {
            // Positions of other sets are not known before the program runs.
            Some(Node::Dem(dem)) if *coords == CoordSetId::BLOCK => dem.holds(window),
            Some(Node::Dem(dem)) => !dem.path.ground().is_some_and(|ground| ground.is_part()),
            _ => true,
        },
        _ => true,
    })
}

fn node_of(recipe: &Recipe, node: NodeId) -> Option<&Node> {
    recipe.nodes().get(node.index()).map(|named| &named.node)
}
