//! What has been solved, by the key of its content.

use crate::error::Result;
use crate::op::Solution;
use crate::plan::key::Key;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Solutions in memory.
///
/// No lock is held while a solution is made: a thread that waits for work of its own may be lent to another request for the
/// same solution, and would then wait for itself. Two requests at the same moment may so both make it; they make the same bits,
/// and the first is kept.
#[derive(Default)]
pub struct Store {
    solutions: Mutex<HashMap<Key, Arc<Solution>>>,
}

impl Store {
    /// The solution stored under `key`, made first if there is none. A failure stores nothing.
    ///
    /// # Errors
    /// Whatever `make` fails with.
    pub fn solution(&self, key: Key, make: impl FnOnce() -> Result<Solution>) -> Result<Arc<Solution>> {
        if let Some(solution) = self.lock().get(&key) {
            return Ok(Arc::clone(solution));
        }
        let made = Arc::new(make()?);
        Ok(Arc::clone(self.lock().entry(key).or_insert(made)))
    }

    /// A lock whose holder panicked still guards sound data: solutions go in whole.
    fn lock(&self) -> MutexGuard<'_, HashMap<Key, Arc<Solution>>> {
        self.solutions.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
