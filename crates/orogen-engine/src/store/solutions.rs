//! What has been solved, by the key of its content.

use super::cache::Cache;
use crate::op::Solution;
use crate::plan::key::Key;
use orogen_grid::error::Result;
use orogen_grid::progress::Progress;
use std::collections::{HashMap, HashSet};
use std::path::PathBuf;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Solutions in memory, and behind them those in a folder.
///
/// No lock is held while a solution is made, but its key is marked: whoever else wants it then waits for it ([`Store::begin`]) instead of making it
/// again.
pub struct Store {
    held: Mutex<Entries>,
    /// Told whenever the making of a solution ends.
    ended: Condvar,
    cache: Option<Cache>,
    /// Where rasters are put that do not fit in memory.
    scratch: PathBuf,
}

#[derive(Default)]
struct Entries {
    solutions: HashMap<Key, (u64, Arc<Solution>)>,
    /// Solutions that are being made.
    making: HashSet<Key>,
    turn: u64,
    /// How many were made so far.
    made: u64,
}

/// What [`Store::begin`] found.
pub enum Begun<'a> {
    /// The solution: somebody else has just made it.
    Found(Arc<Solution>),
    /// Nobody has made it, nor is making it: the caller does.
    Make(Making<'a>),
}

/// The right and the duty to make a solution. If it is dropped before it is finished, the next one who wants the solution makes it.
pub struct Making<'a> {
    store: &'a Store,
    key: Key,
    /// Whether the key is marked: not where the same solution is being made by a thread that cannot be waited for.
    marked: bool,
    /// When it was begun, where a cache wants to know; not every host has a clock.
    begun: Option<Instant>,
}

impl Making<'_> {
    /// Stores the solution, and in the cache's folder if it took long.
    pub fn finish(self, made: Solution) -> Arc<Solution> {
        if let Some(cache) = self.store.cache.as_ref()
            && self.begun.is_none_or(|begun| begun.elapsed() >= cache.slower_than)
        {
            cache.keep(&self.key, &made);
        }
        self.store.lock().made += 1;
        self.store.hold(self.key, Arc::new(made), false)
    }
}

impl Drop for Making<'_> {
    fn drop(&mut self) {
        if self.marked {
            self.store.lock().making.remove(&self.key);
            self.store.ended.notify_all();
        }
    }
}

/// How often a thread that waits for a solution looks whether it was cancelled.
const PATIENCE: Duration = Duration::from_millis(20);

impl Store {
    /// A store that finds solutions of earlier runs in `cache`, and puts what does not fit in memory into `scratch`: if nobody
    /// says, the cache's folder, or else the system's folder for temporary files.
    pub fn new(cache: Option<Cache>, scratch: Option<PathBuf>) -> Store {
        let scratch = scratch.or_else(|| cache.as_ref().map(|cache| cache.folder.clone()));
        Store {
            held: Mutex::default(),
            ended: Condvar::new(),
            cache,
            scratch: scratch.unwrap_or_else(temporary_folder),
        }
    }

    /// A store that holds these solutions, and keeps no others for later runs.
    pub fn holding(solutions: Vec<(Key, Arc<Solution>)>, scratch: PathBuf) -> Store {
        let solutions = solutions.into_iter().map(|(key, solution)| (key, (0, solution))).collect();
        let held = Mutex::new(Entries { solutions, ..Entries::default() });
        Store { held, ended: Condvar::new(), cache: None, scratch }
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

    /// Begins to make the solution of a key, unless somebody else is making it: then waits for it if `may_wait`, and makes it a second time if not (the
    /// bits are the same, and the first is kept). A thread may not wait if the solution could be made further down its own stack, as on the threads of
    /// the pool that solves it.
    ///
    /// # Errors
    /// If `progress` is cancelled while it waits.
    pub fn begin(&self, key: &Key, may_wait: bool, progress: &Progress) -> Result<Begun<'_>> {
        let mut held = self.lock();
        loop {
            if let Some((_, solution)) = held.solutions.get(key) {
                return Ok(Begun::Found(Arc::clone(solution)));
            }
            let marked = held.making.insert(*key);
            if marked || !may_wait {
                return Ok(Begun::Make(self.making(*key, marked)));
            }
            progress.check()?;
            held = self.ended.wait_timeout(held, PATIENCE).unwrap_or_else(PoisonError::into_inner).0;
        }
    }

    fn making(&self, key: Key, marked: bool) -> Making<'_> {
        Making { store: self, key, marked, begun: self.cache.is_some().then(Instant::now) }
    }

    /// Begins to make a solution whether it is stored or not.
    pub fn begin_again(&self, key: &Key) -> Begun<'_> {
        Begun::Make(self.making(*key, false))
    }

    /// How many solutions were made, those found again not counted.
    pub fn made(&self) -> u64 {
        self.lock().made
    }

    /// Bytes of the solutions in memory.
    pub fn memory(&self) -> u64 {
        self.lock().solutions.values().map(|(_, solution)| solution.memory()).sum()
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

/// The system's folder for temporary files. A host without files has none, and does not get to the point of needing it.
fn temporary_folder() -> PathBuf {
    match cfg!(all(target_family = "wasm", not(target_os = "wasi"))) {
        true => PathBuf::new(),
        false => std::env::temp_dir(),
    }
}
