//! A cache of encoded tiles: the least recently used ones are dropped.

use std::collections::{BTreeMap, HashMap};

use axum::body::Bytes;

/// Memory of an entry beside its bytes and its key.
const ENTRY: usize = 160;

/// Tiles by their keys, within a number of bytes.
pub struct TileCache {
    entries: HashMap<String, (Bytes, u64)>,
    /// Keys by the time of their last use.
    used: BTreeMap<u64, String>,
    clock: u64,
    bytes: usize,
    limit: usize,
}

impl TileCache {
    /// An empty cache of at most `limit` bytes.
    pub fn new(limit: usize) -> TileCache {
        TileCache { entries: HashMap::new(), used: BTreeMap::new(), clock: 0, bytes: 0, limit }
    }

    /// The bytes that it holds.
    pub fn bytes(&self) -> usize {
        self.bytes
    }

    /// A tile.
    pub fn get(&mut self, key: &str) -> Option<Bytes> {
        let (bytes, time) = self.entries.get_mut(key)?;
        self.clock += 1;
        if let Some(key) = self.used.remove(time) {
            self.used.insert(self.clock, key);
        }
        *time = self.clock;
        Some(bytes.clone())
    }

    /// Keeps a tile, unless it would take more than a quarter of the cache.
    pub fn insert(&mut self, key: String, bytes: Bytes) {
        let size = |key: &str, bytes: &Bytes| bytes.len() + 2 * key.len() + ENTRY;
        let needed = size(&key, &bytes);
        if needed > self.limit / 4 || self.entries.contains_key(&key) {
            return;
        }
        while self.bytes + needed > self.limit {
            let Some((_, oldest)) = self.used.pop_first() else { break };
            if let Some((bytes, _)) = self.entries.remove(&oldest) {
                self.bytes -= size(&oldest, &bytes);
            }
        }
        self.clock += 1;
        self.bytes += needed;
        self.used.insert(self.clock, key.clone());
        self.entries.insert(key, (bytes, self.clock));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_recently_used_tiles_are_dropped() {
        let mut cache = TileCache::new(10 * (1000 + ENTRY + 2));
        let tile = || Bytes::from(vec![0; 1000]);
        for key in 'a'..='j' {
            cache.insert(key.to_string(), tile());
        }
        assert!(cache.get("a").is_some() && cache.get("nothing").is_none());
        cache.insert("k".into(), tile());
        cache.insert("k".into(), tile());
        assert!(cache.get("a").is_some() && cache.get("b").is_none() && cache.get("k").is_some());
        assert_eq!((cache.bytes(), cache.entries.len(), cache.used.len()), (cache.limit, 10, 10));
        cache.insert("large".into(), Bytes::from(vec![0; 5000]));
        assert!(cache.get("large").is_none());
    }
}
