//! Grids of expensive filters, kept for later requests.

use crate::plan::key::Key;
use orogen_grid::grid::{Grid, Window};
use std::collections::HashMap;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Minimum cost of a filter whose grids are kept, in nanoseconds per sample; copying a grid takes about one.
pub const EXPENSIVE: f64 = 25.0;

/// Grids by the filter's content key, the layer and the window. The least recently used ones are dropped if the limit
/// is exceeded.
pub struct GridStore<G = Grid> {
    limit: u64,
    held: Mutex<Entries<G>>,
}

struct Entries<G> {
    grids: HashMap<GridKey, (u64, G)>,
    bytes: u64,
    turn: u64,
    /// The number of requests whose grids were all present.
    found: u64,
}

/// The key of a grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct GridKey {
    /// The content key of the filter.
    pub node: Key,
    /// The layer.
    pub layer: usize,
    /// First column and row, number of columns and rows.
    samples: [i64; 4],
    /// The bits of the cell.
    cell: u64,
}

impl GridKey {
    /// Size of the grid, in bytes.
    fn bytes(&self) -> u64 {
        4 * self.samples[2].unsigned_abs() * self.samples[3].unsigned_abs()
    }

    /// The key of a layer of a filter over a window.
    pub fn new(node: Key, layer: usize, window: &Window) -> GridKey {
        let samples = [window.x, window.y, window.width as i64, window.height as i64];
        GridKey { node, layer, samples, cell: window.cell.to_bits() }
    }
}

impl<G: Clone> GridStore<G> {
    /// A store of at most `limit` bytes.
    pub fn new(limit: u64) -> GridStore<G> {
        let none = Entries { grids: HashMap::new(), bytes: 0, turn: 0, found: 0 };
        GridStore { limit, held: Mutex::new(none) }
    }

    /// Maximum size of all grids, in bytes.
    pub fn limit(&self) -> u64 {
        self.limit
    }

    /// Whether the store can keep grids.
    pub fn is_used(&self) -> bool {
        self.limit > 0
    }

    /// Copies of all these grids, if all of them are present.
    pub fn find(&self, keys: &[GridKey]) -> Option<Vec<G>> {
        let mut held = self.lock();
        if !keys.iter().all(|key| held.grids.contains_key(key)) {
            return None;
        }
        held.turn += 1;
        held.found += 1;
        let turn = held.turn;
        let grid = |key: &GridKey| {
            held.grids.get_mut(key).map(|(used, grid)| {
                *used = turn;
                grid.clone()
            })
        };
        keys.iter().map(grid).collect()
    }

    /// Whether all these grids are present.
    pub fn has(&self, keys: &[GridKey]) -> bool {
        let held = self.lock();
        keys.iter().all(|key| held.grids.contains_key(key))
    }

    /// Keeps a copy of a grid, if it fits in the limit and in `allowed`, the bytes that all grids may take now (`None`
    /// for no such limit).
    pub fn keep(&self, key: GridKey, grid: &G, allowed: Option<u64>) {
        let bytes = key.bytes();
        let mut held = self.lock();
        let allowed = self.limit.min(allowed.unwrap_or(u64::MAX));
        // A very large grid would displace all others.
        if bytes > allowed.min(self.limit / 2) || held.grids.contains_key(&key) {
            return;
        }
        held.shrink(allowed - bytes);
        held.turn += 1;
        let turn = held.turn;
        held.bytes += bytes;
        held.grids.insert(key, (turn, grid.clone()));
    }

    /// The number of requests whose grids were all present.
    pub fn found(&self) -> u64 {
        self.lock().found
    }

    /// Drops grids until they take at most `allowed` bytes.
    pub fn make_room(&self, allowed: u64) {
        self.lock().shrink(allowed);
    }

    /// Size of all grids, in bytes.
    pub fn memory(&self) -> u64 {
        self.lock().bytes
    }

    /// Grids are inserted as a whole, so the data is consistent even after a panic of another thread.
    fn lock(&self) -> MutexGuard<'_, Entries<G>> {
        self.held.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<G> Entries<G> {
    fn shrink(&mut self, allowed: u64) {
        while self.bytes > allowed {
            let oldest = self.grids.iter().min_by_key(|(_, (used, _))| *used).map(|(key, _)| *key);
            let Some((key, _)) = oldest.and_then(|key| self.grids.remove_entry(&key)) else { return };
            self.bytes -= key.bytes();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(value: f32) -> Grid {
        Grid::filled(Window::new(10, 10, 1.0), value)
    }

    fn key(node: u8) -> GridKey {
        GridKey::new([node; 32], 0, &Window::new(10, 10, 1.0))
    }

    #[test]
    fn the_longest_unused_goes_first_and_the_limit_is_kept() {
        let store = GridStore::new(1000);
        store.keep(key(1), &grid(1.0), None);
        store.keep(key(2), &grid(2.0), None);
        assert_eq!(store.find(&[key(1)]).unwrap()[0], grid(1.0));
        store.keep(key(3), &grid(3.0), None);
        assert!(store.find(&[key(2)]).is_none() && store.find(&[key(1), key(3)]).is_some());
        assert_eq!(store.memory(), 800);
        store.keep(key(4), &grid(4.0), Some(399));
        assert_eq!(store.memory(), 800, "memory that is in use is not taken");
        store.keep(key(4), &grid(4.0), Some(500));
        assert_eq!(store.memory(), 400, "the others make room");
        assert!(store.find(&[key(4)]).is_some());
        store.make_room(399);
        assert_eq!(store.memory(), 0);
    }

    #[test]
    fn what_never_fits_is_not_kept() {
        let store = GridStore::new(399);
        store.keep(key(1), &grid(1.0), None);
        assert!(store.find(&[key(1)]).is_none());
        assert!(!GridStore::<Grid>::new(0).is_used());
    }
}
