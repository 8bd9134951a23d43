//! Blocks of tiles that are made together. They are as large as memory allows and threads can use.

use std::collections::BTreeSet;

use super::job::Stage;
use super::target::BuildTarget;
use orogen_engine::world::World;
use orogen_grid::error::Result;
use orogen_grid::grid::Window;

/// Minimum number of tiles per thread in a block; with fewer, threads would wait for each other at the end of the
/// block.
const TILES_A_THREAD: usize = 4;

/// Number of tiles that are made together, across and down.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Block {
    /// Tiles across.
    pub columns: usize,
    /// Tiles down.
    pub rows: usize,
    /// Maximum memory for making a block, in bytes.
    pub memory: u64,
    /// Number of encoded tiles that wait until they are written.
    pub waiting: usize,
}

impl Block {
    /// The largest block within the memory limit, up to the number of tiles that keeps all threads busy.
    ///
    /// # Errors
    /// If not even one tile fits in the memory limit, or the world does not have these samples.
    pub fn fitting(
        world: &World,
        target: &dyn BuildTarget,
        stage: Stage,
        layers: &[&str],
        waiting: usize,
    ) -> Result<Block> {
        let of = |columns: usize, rows: usize| -> Result<Block> {
            let memory = memory(world, target, layers, [columns, rows], waiting)?;
            Ok(Block { columns, rows, memory, waiting })
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
            // Wide rather than tall, because programs run along rows.
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

    /// The requested tiles, grouped by block.
    pub fn groups(&self, wanted: &BTreeSet<(usize, usize)>, stage: Stage) -> Vec<Vec<(usize, usize)>> {
        let mut groups = Vec::new();
        for top in (0..stage.rows).step_by(self.rows) {
            for left in (0..stage.columns).step_by(self.columns) {
                let (bottom, right) = ((top + self.rows).min(stage.rows), (left + self.columns).min(stage.columns));
                // A partial block is halved until each piece is complete, so that no other tile is computed.
                let mut pieces = vec![(top..bottom, left..right)];
                while let Some((rows, columns)) = pieces.pop() {
                    let all = rows.clone().flat_map(|row| columns.clone().map(move |column| (row, column)));
                    let some: Vec<(usize, usize)> = all.filter(|tile| wanted.contains(tile)).collect();
                    if some.len() == rows.len() * columns.len() {
                        groups.push(some);
                    } else if some.is_empty() {
                    } else if rows.len() > columns.len() {
                        let middle = rows.start + rows.len() / 2;
                        pieces.extend([(middle..rows.end, columns.clone()), (rows.start..middle, columns)]);
                    } else {
                        let middle = columns.start + columns.len() / 2;
                        pieces.extend([(rows.clone(), middle..columns.end), (rows, columns.start..middle)]);
                    }
                }
            }
        }
        groups
    }
}

/// Memory for making this many tiles together, in bytes.
fn memory(
    world: &World,
    target: &dyn BuildTarget,
    layers: &[&str],
    [columns, rows]: [usize; 2],
    waiting: usize,
) -> Result<u64> {
    let window = union(target, (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))));
    let Some(window) = window else { return Ok(0) };
    let beside = memory_beside(world, target, layers, waiting);
    let allowed = world.memory_limit().map(|limit| limit.saturating_sub(beside));
    Ok(world.memory_of(&world.plan_within(layers, &window, allowed)?)?.saturating_add(beside))
}

/// Memory in addition to a block, in bytes: for each thread a tile cut out of it, and its encoding; and `waiting`
/// encodings.
pub fn memory_beside(world: &World, target: &dyn BuildTarget, layers: &[&str], waiting: usize) -> u64 {
    let samples = target.window(0, 0).len() as u64 * 4;
    let (tiles, waiting) = ((layers.len() * world.threads()) as u64, (layers.len() * waiting) as u64);
    (samples + target.scratch_memory()).saturating_mul(tiles).saturating_add(samples.saturating_mul(waiting))
}

/// The window that contains the windows of all these tiles.
pub fn union(target: &dyn BuildTarget, tiles: impl Iterator<Item = (usize, usize)>) -> Option<Window> {
    tiles.map(|(row, column)| target.window(row, column)).reduce(|all, tile| all.union(&tile))
}
