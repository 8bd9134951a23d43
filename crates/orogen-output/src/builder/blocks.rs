//! Tiles that are made together: one window of the world, as large as memory and threads make worth while.

use std::collections::BTreeSet;

use super::job::Stage;
use super::target::BuildTarget;
use orogen_engine::world::World;
use orogen_grid::error::Result;
use orogen_grid::grid::Window;

/// How many tiles a thread should find in a block: fewer, and threads wait for each other at its end.
const TILES_A_THREAD: usize = 4;

/// How many tiles are made together, across and down.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Block {
    /// Tiles across.
    pub columns: usize,
    /// Tiles down.
    pub rows: usize,
    /// Bytes that making one takes at most.
    pub memory: u64,
}

impl Block {
    /// The largest block that memory allows, up to as many tiles as keep all threads busy.
    ///
    /// # Errors
    /// If not even one tile can be made in the memory allowed, or the world does not have these samples.
    pub fn fitting(world: &World, target: &dyn BuildTarget, stage: Stage, layers: &[&str]) -> Result<Block> {
        let of = |columns: usize, rows: usize| -> Result<Block> {
            let memory = memory(world, target, layers, columns, rows)?;
            Ok(Block { columns, rows, memory })
        };
        let mut block = of(1, 1)?;
        let allowed = world.memory_limit().unwrap_or(u64::MAX);
        if block.memory > allowed {
            let instead = "use smaller tiles, or raise the memory limit";
            return Err(world.budget().refusal("making one tile", block.memory, instead));
        }
        let enough = TILES_A_THREAD * world.threads();
        while block.columns * block.rows < enough {
            let (across, down) = ((2 * block.columns).min(stage.columns), (2 * block.rows).min(stage.rows));
            // Wide rather than tall: rows are what programs run along.
            let larger = if block.columns <= block.rows && across > block.columns || down == block.rows {
                of(across, block.rows)?
            } else {
                of(block.columns, down)?
            };
            if larger.memory > allowed || (larger.columns, larger.rows) == (block.columns, block.rows) {
                break;
            }
            block = larger;
        }
        Ok(block)
    }

    /// The tiles that are wanted, in groups that are made together.
    pub fn groups(&self, wanted: &BTreeSet<(usize, usize)>, stage: Stage) -> Vec<Vec<(usize, usize)>> {
        let mut groups = Vec::new();
        for top in (0..stage.rows).step_by(self.rows) {
            for left in (0..stage.columns).step_by(self.columns) {
                let (bottom, right) = ((top + self.rows).min(stage.rows), (left + self.columns).min(stage.columns));
                let all = (top..bottom).flat_map(|row| (left..right).map(move |column| (row, column)));
                let some: Vec<(usize, usize)> = all.filter(|tile| wanted.contains(tile)).collect();
                if some.len() == (bottom - top) * (right - left) {
                    groups.push(some);
                } else {
                    // What is left of a block is made one by one, so that nothing is made twice.
                    groups.extend(some.into_iter().map(|tile| vec![tile]));
                }
            }
        }
        groups
    }
}

/// Bytes that making so many tiles together takes.
fn memory(world: &World, target: &dyn BuildTarget, layers: &[&str], columns: usize, rows: usize) -> Result<u64> {
    let window = union(target, (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))));
    let Some(window) = window else { return Ok(0) };
    let plan = world.memory_of(&world.plan(layers, &window)?);
    // Beside the block: for each thread a tile cut out of it, and what is made of that.
    let tile = target.window(0, 0).len() as u64 * 4 + target.scratch_memory();
    Ok(plan.saturating_add(tile.saturating_mul((layers.len() * world.threads()) as u64)))
}

/// The window that holds all of these tiles' windows.
pub fn union(target: &dyn BuildTarget, tiles: impl Iterator<Item = (usize, usize)>) -> Option<Window> {
    tiles.map(|(row, column)| target.window(row, column)).reduce(|all, tile| all.union(&tile))
}
