//! The heights that a plan reads: which windows of large files, and whether they are available.

use super::steps::{Plan, Step};
use crate::recipe::document::Recipe;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;
use orogen_io::dem::dem_file::DemFile;
use orogen_io::dem::prepared::PreparedDem;
use orogen_ops::field::{Dem, DemShows};
use orogen_ops::ids::{CoordSetId, Id, NodeId};
use orogen_ops::node::Node;
use orogen_ops::program::Instruction;
use std::sync::Arc;

/// The heights that a plan reads of a file whose windows are read when they are requested.
struct Need<'r> {
    file: &'r DemFile,
    /// The window on the lattice of the file; `None` for all heights.
    window: Option<Window>,
}

/// The heights that a plan reads of each node's file, if the windows of the file are read when they are requested.
fn needs<'r>(plan: &Plan, recipe: &'r Recipe) -> Vec<Need<'r>> {
    let of_node = |(at, dem): (usize, &'r Dem)| {
        let file = dem.path.dem_file()?;
        let mut need: Option<Need> = None;
        for (window, is_block) in plan.steps.iter().filter_map(|step| reading(step, at)) {
            // Positions of other sets are not known before the program runs.
            let read = is_block.then(|| dem.reads(&window)).flatten();
            let window = match (need, read) {
                (None, read) => read,
                (Some(Need { window: Some(all), .. }), Some(read)) => Some(all.union(&read)),
                _ => None,
            };
            need = Some(Need { file, window });
        }
        need
    };
    let dems = recipe.nodes().iter().enumerate().filter_map(|(at, named)| match &named.node {
        Node::Dem(dem) if dem.shows == DemShows::Height => Some((at, dem)),
        _ => None,
    });
    dems.filter_map(of_node).collect()
}

/// The window over which a step reads a node, and whether it reads it only at the samples of the window.
fn reading(step: &Step, at: usize) -> Option<(Window, bool)> {
    let Step::Fill { program, window, out } = step else { return None };
    let mut reads = program.instructions.iter().filter_map(|instruction| match instruction {
        Instruction::Field { node, coords, .. } if node.index() == at => Some(*coords == CoordSetId::BLOCK),
        _ => None,
    });
    let first = reads.next()?;
    // A program without grids is evaluated at any points.
    Some((*window, first && reads.all(|is_block| is_block) && !out.is_empty()))
}

/// Memory of the windows of files that a plan reads, in bytes.
pub fn memory(plan: &Plan, recipe: &Recipe) -> u64 {
    needs(plan, recipe).iter().fold(0, |sum, need| sum.saturating_add(need.file.memory(need.window.as_ref())))
}

/// Memory of the windows of files that a tile of a solver's source reads, in bytes. Twice as much as without holes,
/// since heights around large holes are not known before.
pub fn memory_of_tile(plan: &Plan, recipe: &Recipe) -> u64 {
    memory(plan, recipe).saturating_mul(2)
}

/// Reads the windows of files that a plan reads. They are available as long as the result is held.
///
/// # Errors
/// If a file cannot be read or was changed, or its heights need more than `allowed` bytes.
pub fn read(plan: &Plan, recipe: &Recipe, allowed: u64) -> Result<Vec<Arc<PreparedDem>>> {
    let mut left = allowed;
    let mut held = Vec::new();
    for need in needs(plan, recipe) {
        let heights = need.file.read(need.window.as_ref(), left)?;
        left = left.saturating_sub(heights.memory());
        held.push(heights);
    }
    Ok(held)
}

/// Checks that a plan uses only heights that have been read from their files. Solvers read the whole world, and points
/// may be anywhere in it: a part of a file is not enough for them.
///
/// # Errors
/// [`ErrorKind::Part`] if it needs other heights.
pub fn check(plan: &Plan, recipe: &Recipe) -> Result<()> {
    if !recipe.nodes().iter().any(|named| matches!(&named.node, Node::Dem(dem) if is_part(dem))) {
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

/// Whether only a part of a file was read, and no other can be.
fn is_part(dem: &Dem) -> bool {
    dem.path.dem_file().is_none() && dem.path.ground().is_some_and(|ground| ground.is_part())
}

fn holds(step: &Step, recipe: &Recipe) -> bool {
    let Step::Fill { program, window, .. } = step else { return true };
    program.instructions.iter().all(|instruction| match instruction {
        Instruction::Field { node, coords, .. } => match &node_of(recipe, *node) {
            // Positions of other sets are not known before the program runs.
            Some(Node::Dem(dem)) if is_part(dem) => *coords == CoordSetId::BLOCK && dem.holds(window),
            _ => true,
        },
        _ => true,
    })
}

fn node_of(recipe: &Recipe, node: NodeId) -> Option<&Node> {
    recipe.nodes().get(node.index()).map(|named| &named.node)
}
