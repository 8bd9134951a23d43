//! Solutions in memory, for several sessions of one process.

use super::solution_store::{Entry, EntryKey, SolutionStore};
use orogen_io::read_at::ReadAt;
use std::collections::HashMap;
use std::io;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// A store in memory, up to a limit. Its memory does not count towards the budget of any session.
#[derive(Debug)]
pub struct MemoryStore {
    limit: u64,
    held: Mutex<Held>,
}

#[derive(Debug, Default)]
struct Held {
    /// Each entry with the time of its last use.
    entries: HashMap<EntryKey, (u64, Arc<Vec<u8>>)>,
    turn: u64,
    bytes: u64,
}

impl MemoryStore {
    /// An empty store of at most `limit` bytes. If the limit is exceeded, the least recently used entries are removed.
    #[must_use]
    pub fn new(limit: u64) -> MemoryStore {
        MemoryStore { limit, held: Mutex::default() }
    }

    /// Number of entries.
    #[must_use]
    pub fn entries(&self) -> usize {
        self.lock().entries.len()
    }

    /// Size of all entries, in bytes.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.lock().bytes
    }

    /// Removes all entries.
    pub fn clear(&self) {
        *self.lock() = Held::default();
    }

    /// Entries are inserted as a whole, so the data is consistent even after a panic of another thread.
    fn lock(&self) -> MutexGuard<'_, Held> {
        self.held.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Held {
    fn remove(&mut self, key: &EntryKey) {
        if let Some((_, bytes)) = self.entries.remove(key) {
            self.bytes -= bytes.len() as u64;
        }
    }
}

impl SolutionStore for MemoryStore {
    fn get(&self, key: &EntryKey) -> io::Result<Option<Box<dyn ReadAt>>> {
        let mut held = self.lock();
        held.turn += 1;
        let turn = held.turn;
        Ok(held.entries.get_mut(key).map(|(used, bytes)| {
            *used = turn;
            Box::new(Arc::clone(bytes)) as Box<dyn ReadAt>
        }))
    }

    fn put(&self, key: &EntryKey, entry: &Entry) -> io::Result<()> {
        if entry.length() > self.limit {
            return Ok(());
        }
        let bytes = entry.to_bytes()?;
        let mut held = self.lock();
        held.remove(key);
        while held.bytes + bytes.len() as u64 > self.limit {
            let oldest = held.entries.iter().min_by_key(|(_, (used, _))| *used).map(|(key, _)| *key);
            let Some(oldest) = oldest else { return Ok(()) };
            held.remove(&oldest);
        }
        held.turn += 1;
        let turn = held.turn;
        held.bytes += bytes.len() as u64;
        held.entries.insert(*key, (turn, Arc::new(bytes)));
        Ok(())
    }

    fn contains(&self, key: &EntryKey) -> bool {
        self.lock().entries.contains_key(key)
    }

    fn remove(&self, key: &EntryKey) -> io::Result<()> {
        self.lock().remove(key);
        Ok(())
    }

    fn keeps_tiles(&self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_ops::op::Solution;

    #[test]
    fn the_longest_unused_goes_first_and_the_limit_is_kept() {
        let solution = |scalars: usize| Solution { layers: Vec::new(), scalars: vec![1.5; scalars] };
        let key = |k: u8| EntryKey([k; 32]);
        let length = Entry::new(&key(0), &solution(10)).length();
        let store = MemoryStore::new(2 * length);
        let put = |k: u8, scalars| store.put(&key(k), &Entry::new(&key(k), &solution(scalars))).unwrap();
        put(1, 10);
        put(2, 10);
        assert_eq!(store.get(&key(1)).unwrap().unwrap().length().unwrap(), length, "used again");
        put(3, 10);
        assert_eq!([1, 2, 3].map(|k| store.contains(&key(k))), [true, false, true]);
        put(3, 10);
        assert_eq!((store.entries(), store.bytes()), (2, 2 * length), "replaced");
        put(4, 1000);
        assert!(!store.contains(&key(4)) && store.contains(&key(1)), "what is larger than the limit is not kept");
        store.remove(&key(1)).unwrap();
        store.remove(&key(1)).unwrap();
        assert!(store.get(&key(1)).unwrap().is_none());
        assert_eq!((store.entries(), store.bytes()), (1, length));
        store.clear();
        assert_eq!((store.entries(), store.bytes()), (0, 0));
    }
}
