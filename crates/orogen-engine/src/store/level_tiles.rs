//! Tiles of the levels of levelled ops, in memory, each made by one request at a time.

use super::grids::{GridKey, GridStore};
use super::level_tile::LevelTile;
use orogen_grid::error::Result;
use orogen_grid::grid::Grid;
use orogen_grid::progress::Progress;
use std::collections::HashSet;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Tiles in memory.
///
/// No lock is held while a tile is made, but the tile is marked: other requests that need it wait
/// ([`LevelTiles::claim`]) instead of making it again.
pub struct LevelTiles {
    grids: GridStore,
    /// Tiles that are being made.
    making: Mutex<HashSet<GridKey>>,
    /// Notified when a tile has been kept, or is no longer being made.
    ended: Condvar,
    made: AtomicU64,
}

/// Permission to make a tile. When it is dropped, others may make the tile, if it was not kept.
pub struct Claim<'a> {
    tiles: &'a LevelTiles,
    /// The mark of the tile; `None` if another request also makes the tile and the caller may not wait for it.
    mark: Option<GridKey>,
}

impl Drop for Claim<'_> {
    fn drop(&mut self) {
        if let Some(mark) = self.mark {
            self.tiles.making().remove(&mark);
            self.tiles.ended.notify_all();
        }
    }
}

/// Interval at which a waiting thread checks for cancellation.
const PATIENCE: Duration = Duration::from_millis(20);

impl LevelTiles {
    /// A cache for tiles of at most `limit` bytes.
    pub fn new(limit: u64) -> LevelTiles {
        LevelTiles {
            grids: GridStore::new(limit),
            making: Mutex::default(),
            ended: Condvar::new(),
            made: AtomicU64::new(0),
        }
    }

    /// Maximum size of all tiles, in bytes.
    pub fn limit(&self) -> u64 {
        self.grids.limit()
    }

    /// A copy of the planes of a tile.
    pub fn find(&self, tile: &LevelTile) -> Option<Vec<Grid>> {
        self.grids.find(&tile.grids())
    }

    /// Permission to make all these tiles. `None` if the caller must look for them again, because one has been kept
    /// since, or another request that made one has ended.
    ///
    /// If another request makes one of them, the caller waits for it if it `may_wait`. Meanwhile it has no permission
    /// for any tile, so requests never wait for each other. A caller that may not wait makes the tile a second time;
    /// the bits are the same, and the first result is kept. A thread must not wait if the tile may be made further down
    /// its own stack, as on the threads of the pool.
    ///
    /// # Errors
    /// If `progress` is cancelled during the wait.
    pub fn claim(&self, tiles: &[LevelTile], may_wait: bool, progress: &Progress) -> Result<Option<Vec<Claim<'_>>>> {
        let mut making = self.making();
        let mut waited = false;
        loop {
            // A tile is kept before its mark is removed: a tile without a mark is either kept or not being made.
            if tiles.iter().any(|tile| self.grids.has(&tile.grids())) {
                return Ok(None);
            }
            let is_made = tiles.iter().any(|tile| making.contains(&tile.mark()));
            if !is_made && waited {
                return Ok(None);
            }
            if !is_made || !may_wait {
                let marks = tiles.iter().map(LevelTile::mark);
                let claim = |mark| Claim { tiles: self, mark: making.insert(mark).then_some(mark) };
                return Ok(Some(marks.map(claim).collect()));
            }
            progress.check()?;
            making = self.ended.wait_timeout(making, PATIENCE).unwrap_or_else(PoisonError::into_inner).0;
            waited = true;
        }
    }

    /// Counts a tile that was made.
    pub fn count_made(&self) {
        self.made.fetch_add(1, Ordering::Relaxed);
    }

    /// Number of tiles made so far, without reused ones.
    pub fn made(&self) -> u64 {
        self.made.load(Ordering::Relaxed)
    }

    /// Keeps a copy of the planes of a tile, if it fits in the limit and in `allowed`, the bytes that all tiles may
    /// take now (`None` for no such limit).
    pub fn keep(&self, tile: &LevelTile, planes: &[Grid], allowed: Option<u64>) {
        tile.grids().into_iter().zip(planes).for_each(|(key, plane)| self.grids.keep(key, plane, allowed));
    }

    /// Drops tiles until they take at most `allowed` bytes.
    pub fn make_room(&self, allowed: u64) {
        self.grids.make_room(allowed);
    }

    /// Size of all tiles, in bytes.
    pub fn memory(&self) -> u64 {
        self.grids.memory()
    }

    /// Marks are inserted and removed one by one, so the set is consistent even after a panic of another thread.
    fn making(&self) -> MutexGuard<'_, HashSet<GridKey>> {
        self.making.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::super::entry_key::EntryKey;
    use super::*;
    use orogen_grid::error::ErrorKind;
    use orogen_grid::grid::Window;

    fn tile(column: i64) -> LevelTile {
        LevelTile { node: [1; 32], level: 3, planes: 2, window: Window::new(8, 8, 1.0).at(8 * column, 0) }
    }

    fn planes(tile: &LevelTile) -> Vec<Grid> {
        vec![Grid::filled(tile.window, 1.0), Grid::filled(tile.window, tile.window.x as f32)]
    }

    fn claim<'a>(tiles: &'a LevelTiles, columns: &[i64], may_wait: bool) -> Option<Vec<Claim<'a>>> {
        let wanted: Vec<LevelTile> = columns.iter().map(|column| tile(*column)).collect();
        tiles.claim(&wanted, may_wait, &Progress::none()).unwrap()
    }

    #[test]
    fn each_part_of_a_key_counts() {
        let one = tile(0);
        let mut keys = HashSet::from([one.entry_key()]);
        assert!(keys.insert(LevelTile { node: [2; 32], ..one }.entry_key()));
        assert!(keys.insert(LevelTile { level: 4, ..one }.entry_key()));
        assert!(keys.insert(LevelTile { window: one.window.at(0, 8), ..one }.entry_key()));
        assert!(keys.insert(LevelTile { window: Window { cell: 2.0, ..one.window }, ..one }.entry_key()));
        assert!(keys.insert(LevelTile { window: Window { height: 9, ..one.window }, ..one }.entry_key()));
        assert!(keys.insert(EntryKey::of(&one.node)), "a solution has another key");
    }

    #[test]
    fn a_request_waits_until_the_tile_is_kept() {
        let tiles = LevelTiles::new(1 << 20);
        let claims = claim(&tiles, &[0, 1], true).unwrap();
        std::thread::scope(|scope| {
            let other = scope.spawn(|| {
                assert!(claim(&tiles, &[1, 2], true).is_none(), "look again");
                assert_eq!(tiles.find(&tile(1)).unwrap(), planes(&tile(1)));
                assert!(tiles.find(&tile(2)).is_none());
                assert!(claim(&tiles, &[2], true).is_some());
            });
            // The claim cannot have been granted yet, whether the thread waits already or not.
            std::thread::sleep(Duration::from_millis(30));
            assert!(!other.is_finished());
            let [first, second] = claims.try_into().ok().unwrap();
            tiles.keep(&tile(1), &planes(&tile(1)), None);
            drop(second);
            other.join().unwrap();
            drop(first);
        });
        assert!(tiles.making().is_empty());
    }

    #[test]
    fn after_a_failure_the_next_request_makes_the_tile() {
        let tiles = LevelTiles::new(1 << 20);
        let claims = claim(&tiles, &[0], true).unwrap();
        std::thread::scope(|scope| {
            let other = scope.spawn(|| {
                // The thread may start too late to wait; it is then allowed to make the tile at once.
                let made = claim(&tiles, &[0], true).or_else(|| claim(&tiles, &[0], true));
                assert!(made.is_some());
            });
            drop(claims);
            other.join().unwrap();
        });
        assert!(tiles.making().is_empty());
    }

    #[test]
    fn a_wait_can_be_cancelled_and_threads_of_the_pool_do_not_wait() {
        let tiles = LevelTiles::new(1 << 20);
        let claims = claim(&tiles, &[0], true).unwrap();
        let progress = Progress::none();
        progress.cancel();
        let cancelled = tiles.claim(&[tile(1), tile(0)], true, &progress).err().unwrap();
        assert_eq!(cancelled.kind(), ErrorKind::Cancelled);
        let twice = claim(&tiles, &[1, 0], false).unwrap();
        drop(twice);
        assert_eq!(tiles.making().len(), 1, "the mark of the first request is still there");
        drop(claims);
        assert!(tiles.making().is_empty());
    }
}
