//! What has been solved, by the key of its content.

use crate::error::Result;
use crate::op::Solution;
use crate::plan::key::Key;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// A place for one solution, empty until it is made.
type Slot = Arc<Mutex<Option<Arc<Solution>>>>;

/// Solutions in memory. Two threads that want the same one make it once.
#[derive(Default)]
pub struct Store {
    solutions: Mutex<HashMap<Key, Slot>>,
}

impl Store {
    /// The solution stored under `key`, made first if there is none. A failure stores nothing.
    ///
    /// # Errors
    /// Whatever `make` fails with.
    pub fn solution(&self, key: Key, make: impl FnOnce() -> Result<Solution>) -> Result<Arc<Solution>> {
        let slot = Arc::clone(lock(&self.solutions).entry(key).or_default());
        let mut slot = lock(&slot);
        if let Some(solution) = slot.as_ref() {
            return Ok(Arc::clone(solution));
        }
        let solution = Arc::new(make()?);
        *slot = Some(Arc::clone(&solution));
        Ok(solution)
    }
}

/// A lock whose holder panicked still guards sound data: slots are filled in one assignment.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
