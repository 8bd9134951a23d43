//! What has been solved, by the key of its content.

use super::cache::Cache;
use crate::error::Result;
use crate::op::Solution;
use crate::plan::key::Key;
use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

/// Solutions at hand, and behind them those in a folder.
///
/// No lock is held while a solution is made: a thread that waits for work of its own may be lent to another request for the
/// same solution, and would then wait for itself. Two requests at the same moment may so both make it; they make the same bits,
/// and the first is kept.
pub struct Store {
    held: Mutex<Entries>,
    cache: Option<Cache>,
    /// Where rasters are put that do not fit in memory.
    scratch: PathBuf,
    /// Solutions made.
    made: AtomicUsize,
}

#[derive(Default)]
struct Entries {
    solutions: HashMap<Key, (u64, Arc<Solution>)>,
    turn: u64,
}

impl Store {
    /// A store that finds solutions of earlier runs in `cache`, and puts what does not fit in memory into `scratch`: if nobody
    /// says, the cache's folder, or else the system's folder for temporary files.
    pub fn new(cache: Option<Cache>, scratch: Option<PathBuf>) -> Store {
        let scratch = scratch.or_else(|| cache.as_ref().map(|cache| cache.folder.clone()));
        Store {
            held: Mutex::default(),
            cache,
            scratch: scratch.unwrap_or_else(std::env::temp_dir),
            made: AtomicUsize::new(0),
        }
    }

    /// A store that holds these solutions, and keeps no others for later runs.
    pub fn holding(solutions: Vec<(Key, Arc<Solution>)>, scratch: PathBuf) -> Store {
        let solutions = solutions.into_iter().map(|(key, solution)| (key, (0, solution))).collect();
        Store { held: Mutex::new(Entries { solutions, turn: 0 }), cache: None, scratch, made: AtomicUsize::new(0) }
    }

    /// How many solutions were made, not found.
    pub fn made(&self) -> usize {
        self.made.load(Ordering::Relaxed)
    }

    /// The folder for what does not fit in memory.
    pub fn scratch(&self) -> &PathBuf {
        &self.scratch
    }

    /// The solution stored under `key`, with its layers on disk if they have to be.
    ///
    /// # Errors
    /// If what is in memory has to move to the disk, which takes no more.
    pub fn find(&self, key: &Key, on_disk: bool) -> Result<Option<Arc<Solution>>> {
        let held = {
            let mut held = self.lock();
            held.turn += 1;
            let turn = held.turn;
            held.solutions.get_mut(key).map(|(used, solution)| {
                *used = turn;
                Arc::clone(solution)
            })
        };
        match held {
            Some(solution) if on_disk && solution.layers.iter().any(|layer| !layer.is_on_disk()) => {
                let layers =
                    solution.layers.iter().map(|layer| layer.copied_to_disk(self.scratch())).collect::<Result<_>>()?;
                let moved = Arc::new(Solution { layers, scalars: solution.scalars.clone() });
                self.hold(*key, Arc::clone(&moved), true);
                Ok(Some(moved))
            }
            Some(solution) => Ok(Some(solution)),
            None => {
                let found = self.cache.as_ref().and_then(|cache| cache.find(key, on_disk));
                Ok(found.map(|solution| self.hold(*key, Arc::new(solution), false)))
            }
        }
    }

    /// Whether a solution is stored under `key`; a file of it may still turn out to be damaged.
    pub fn has(&self, key: &Key) -> bool {
        self.lock().solutions.contains_key(key) || self.cache.as_ref().is_some_and(|cache| cache.has(key))
    }

    /// Makes a solution and stores it under `key`. A failure stores nothing.
    ///
    /// # Errors
    /// Whatever `make` fails with.
    pub fn make(&self, key: &Key, make: impl FnOnce() -> Result<Solution>) -> Result<Arc<Solution>> {
        let begun = Instant::now();
        let made = make()?;
        self.made.fetch_add(1, Ordering::Relaxed);
        if let Some(cache) = self.cache.as_ref().filter(|cache| begun.elapsed() >= cache.slower_than) {
            cache.keep(key, &made);
        }
        Ok(self.hold(*key, Arc::new(made), false))
    }

    /// Lets go of solutions in memory, the longest unused first, until those not among `needed` take at most `allowed` bytes.
    pub fn make_room(&self, allowed: u64, needed: &[Key]) {
        let mut held = self.lock();
        let mut others: Vec<(u64, Key, u64)> = held
            .solutions
            .iter()
            .filter(|(key, _)| !needed.contains(key))
            .map(|(key, (used, solution))| (*used, *key, solution.memory()))
            .collect();
        others.sort_unstable();
        let mut total: u64 = others.iter().map(|(_, _, bytes)| bytes).sum();
        for (_, key, bytes) in others {
            if total <= allowed {
                return;
            }
            held.solutions.remove(&key);
            total -= bytes;
        }
    }

    fn hold(&self, key: Key, solution: Arc<Solution>, over: bool) -> Arc<Solution> {
        let mut held = self.lock();
        held.turn += 1;
        let turn = held.turn;
        if over {
            held.solutions.insert(key, (turn, Arc::clone(&solution)));
            return solution;
        }
        Arc::clone(&held.solutions.entry(key).or_insert((turn, solution)).1)
    }

    /// A lock whose holder panicked still guards sound data: solutions go in whole.
    fn lock(&self) -> MutexGuard<'_, Entries> {
        self.held.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
