//! Results that a session keeps for later requests.

use super::grids::GridStore;
use super::level_tiles::LevelTiles;
use super::solutions::Store;
use crate::device::PlanGrid;
use crate::plan::key::Key;
use orogen_ops::op::Solution;
use std::sync::Arc;

/// Results that a session keeps for later requests. Previews and drafts have separate ones, which are never stored for
/// later runs or used for exact results.
pub struct Kept {
    /// Solutions.
    pub store: Store,
    /// Grids of expensive filters.
    pub grids: GridStore<PlanGrid>,
    /// Tiles of levels.
    pub level_tiles: Arc<LevelTiles>,
}

impl Kept {
    /// Creates an empty cache over a store, with limits in bytes for grids and for tiles.
    pub fn new(store: Store, grids: u64, level_tiles: u64) -> Kept {
        Kept { store, grids: GridStore::new(grids), level_tiles: Arc::new(LevelTiles::new(level_tiles)) }
    }

    /// Creates an empty cache with the same limits and no store behind it.
    pub fn emptied(&self) -> Kept {
        Kept::new(self.store.holding(Vec::new()), self.grids.limit(), self.level_tiles.limit())
    }

    /// Creates a cache of these solutions and the same tiles, without grids and without a store behind it.
    pub fn with_solutions(&self, solved: Vec<(Key, Arc<Solution>)>) -> Kept {
        Kept { store: self.store.holding(solved), grids: GridStore::new(0), level_tiles: Arc::clone(&self.level_tiles) }
    }

    /// The memory of everything that is kept, in bytes.
    pub fn memory(&self) -> u64 {
        self.store.memory().saturating_add(self.grids.memory()).saturating_add(self.level_tiles.memory())
    }

    /// Drops the least recently used results until at most `allowed` bytes are left, except the solutions in `needed`.
    /// Returns how much of `allowed` is unused.
    pub fn make_room(&self, allowed: u64, needed: &[Key]) -> u64 {
        self.store.make_room(allowed, needed);
        let left = allowed.saturating_sub(self.store.memory());
        self.grids.make_room(left);
        let left = left.saturating_sub(self.grids.memory());
        self.level_tiles.make_room(left);
        left.saturating_sub(self.level_tiles.memory())
    }
}
