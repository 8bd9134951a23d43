//! What was used last, up to a number of entries.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Entries by their keys, of which the least recently used ones are dropped.
pub struct Recent<T> {
    most: usize,
    /// The latest one is last.
    entries: Mutex<Vec<(String, Arc<T>)>>,
}

impl<T> Recent<T> {
    /// At most `most` entries.
    pub fn new(most: usize) -> Recent<T> {
        Recent { most, entries: Mutex::default() }
    }

    /// The entries are consistent at any time, also after a panic of another thread.
    fn lock(&self) -> MutexGuard<'_, Vec<(String, Arc<T>)>> {
        self.entries.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// An entry; it becomes the latest one.
    pub fn find(&self, key: &str) -> Option<Arc<T>> {
        latest(&mut self.lock(), key)
    }

    /// Keeps an entry, unless another thread has kept one under this key meanwhile: then that is the result.
    pub fn keep(&self, key: &str, entry: T) -> Arc<T> {
        let mut entries = self.lock();
        if let Some(found) = latest(&mut entries, key) {
            return found;
        }
        let entry = Arc::new(entry);
        entries.push((key.to_string(), Arc::clone(&entry)));
        let excess = entries.len().saturating_sub(self.most);
        entries.drain(..excess);
        entry
    }
}

/// An entry, which becomes the latest one.
fn latest<T>(entries: &mut Vec<(String, Arc<T>)>, key: &str) -> Option<Arc<T>> {
    let at = entries.iter().position(|(own, _)| own == key)?;
    let found = entries.remove(at);
    let entry = Arc::clone(&found.1);
    entries.push(found);
    Some(entry)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_recently_used_entries_are_dropped() {
        let recent = Recent::new(3);
        for key in ["a", "b", "c"] {
            recent.keep(key, key);
        }
        assert_eq!(recent.find("a").as_deref(), Some(&"a"));
        assert_eq!(*recent.keep("c", "another"), "c");
        recent.keep("d", "d");
        assert_eq!(["a", "b", "c", "d"].map(|key| recent.find(key).is_some()), [true, false, true, true]);
    }
}
