//! What a session keeps for later requests.

use super::grids::GridStore;
use super::level_tiles::LevelTiles;
use super::solutions::Store;
use crate::device::PlanGrid;
use crate::plan::key::Key;
use orogen_ops::op::Solution;
use std::sync::Arc;

/// What requests keep for later ones: those of a session, its previews or its drafts. Nothing of a preview is stored
/// for later runs, and nothing exact is made from it.
pub struct Kept {
    /// Solutions.
    pub store: Store,
    /// Grids of expensive filters.
    pub grids: GridStore<PlanGrid>,
    /// Tiles of levels.
    pub level_tiles: Arc<LevelTiles>,
}

impl Kept {
    /// Nothing but what a store has, with room for at most these bytes of grids and of tiles.
    pub fn new(store: Store, grids: u64, level_tiles: u64) -> Kept {
        Kept { store, grids: GridStore::new(grids), level_tiles: Arc::new(LevelTiles::new(level_tiles)) }
    }

    /// Nothing, with room for as much, and no store behind it.
    pub fn emptied(&self) -> Kept {
        Kept::new(self.store.holding(Vec::new()), self.grids.limit(), self.level_tiles.limit())
    }

    /// These solutions and the same tiles, with room for no grids and no store behind it.
    pub fn with_solutions(&self, solved: Vec<(Key, Arc<Solution>)>) -> Kept {
        Kept { store: self.store.holding(solved), grids: GridStore::new(0), level_tiles: Arc::clone(&self.level_tiles) }
    }

    /// Bytes of all that is kept.
    pub fn memory(&self) -> u64 {
        self.store.memory().saturating_add(self.grids.memory()).saturating_add(self.level_tiles.memory())
    }

    /// Drops what was not used for longest, until all but the solutions in `needed` takes at most `allowed` bytes.
    /// Returns what is left of them.
    pub fn make_room(&self, allowed: u64, needed: &[Key]) -> u64 {
        self.store.make_room(allowed, needed);
        let left = allowed.saturating_sub(self.store.memory());
        self.grids.make_room(left);
        let left = left.saturating_sub(self.grids.memory());
        self.level_tiles.make_room(left);
        left.saturating_sub(self.level_tiles.memory())
    }
}
