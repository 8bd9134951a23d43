//! Tiles of levels in the store for later runs.

use super::level_tile::LevelTile;
use super::solution_store::{Entry, SolutionStore};
use super::solutions::Store;
use super::tile_entry;
use orogen_grid::error::{Error, Result};
use orogen_grid::grid::Grid;
use orogen_io::file;

/// The tiles of a request are stored if they take longer than this part of the time below which solutions are not
/// stored. Many requests share a tile; few share a solution.
const PART: f64 = 0.1;

impl Store {
    /// Whether tiles are looked up in the backing store.
    pub fn has_tiles(&self) -> bool {
        self.backing().is_some_and(SolutionStore::keeps_tiles)
    }

    /// Whether the tiles of a request are stored, if together they take about `work` nanoseconds to make.
    pub fn keeps_tiles(&self, work: f64) -> bool {
        let is_slow = |backing: &dyn SolutionStore| work >= PART * backing.slower_than().as_nanos() as f64;
        self.backing().is_some_and(|backing| backing.keeps_tiles() && is_slow(backing))
    }

    /// The planes of a tile from the backing store, verified. If the store fails or the entry is damaged, the tile is
    /// made instead.
    pub fn find_tile(&self, tile: &LevelTile) -> Option<Vec<Grid>> {
        let found = look_up(self.backing()?, tile);
        found.unwrap_or_else(|error| {
            self.set_failure(error);
            None
        })
    }

    /// Stores the planes of a tile for later runs.
    pub fn store_tile(&self, tile: &LevelTile, planes: &[Grid]) {
        let Some(backing) = self.backing() else { return };
        let key = tile.entry_key();
        if let Err(cause) = backing.put(&key, &Entry::of_tile(&key, tile, planes)) {
            self.set_failure(file::explain("store the tile", &backing.name(&key), &cause));
        }
    }
}

/// The planes that `store` has for a tile; `None` if it has none. A damaged entry is removed.
fn look_up(store: &dyn SolutionStore, tile: &LevelTile) -> Result<Option<Vec<Grid>>> {
    let key = tile.entry_key();
    let name = store.name(&key);
    let bytes = match store.get(&key) {
        Ok(Some(bytes)) => bytes,
        Ok(None) => return Ok(None),
        Err(cause) => return Err(Error::file("read the stored tile", &name, &cause)),
    };
    tile_entry::read(&*bytes, &name, &key, tile).map(Some).inspect_err(|_| {
        // If it cannot be removed, it is detected as damaged again.
        let _ = store.remove(&key);
    })
}
