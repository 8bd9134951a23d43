//! Solutions by content key.

use super::entry;
use super::solution_store::{Entry, EntryKey, SolutionStore};
use crate::plan::key::Key;
use orogen_grid::error::{Error, Result};
use orogen_grid::progress::Progress;
use orogen_io::{file, fs};
use orogen_ops::op::Solution;
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Solutions in memory, backed by a store for later runs.
///
/// No lock is held while a solution is computed, but its key is marked: other threads that need it wait
/// ([`Store::begin`]) instead of computing it again.
pub struct Store {
    held: Mutex<Entries>,
    /// Notified when the computation of a solution ends.
    ended: Condvar,
    backing: Option<Arc<dyn SolutionStore>>,
    /// The folder for rasters that do not fit in memory.
    scratch: PathBuf,
}

#[derive(Default)]
struct Entries {
    solutions: HashMap<Key, (u64, Arc<Solution>)>,
    /// Keys of solutions that are being computed.
    making: HashSet<Key>,
    turn: u64,
    /// Number of solutions computed so far.
    made: u64,
    /// The latest failure of the backing store.
    failure: Option<Error>,
}

/// The result of [`Store::begin`].
pub enum Begun<'a> {
    /// The solution, which another thread has just computed.
    Found(Arc<Solution>),
    /// There is no solution, and no other thread is computing it: the caller must compute it.
    Make(Making<'a>),
}

/// Permission to compute a solution. If it is dropped before it is finished, the next thread that needs the solution
/// computes it.
pub struct Making<'a> {
    store: &'a Store,
    key: Key,
    /// Whether the key is marked: `false` if another thread is computing the same solution and the caller may not wait
    /// for it.
    marked: bool,
}

impl Making<'_> {
    /// Stores the solution, also for later runs if it is slow: `work` is the approximate time of making it on one core,
    /// in nanoseconds.
    pub fn finish(self, made: Solution, work: f64) -> Arc<Solution> {
        if let Some(backing) = self.store.backing.as_deref()
            && work >= backing.slower_than().as_nanos() as f64
            && let Err(error) = store(backing, &self.key, &made)
        {
            self.store.lock().failure = Some(error);
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

/// Interval at which a waiting thread checks for cancellation.
const PATIENCE: Duration = Duration::from_millis(20);

impl Store {
    /// A store backed by another one. `scratch` is the folder for data that does not fit in memory. Default: the folder
    /// of the backing store, otherwise the system's temporary folder.
    pub fn new(backing: Option<Arc<dyn SolutionStore>>, scratch: Option<PathBuf>) -> Store {
        let behind = || backing.as_deref().and_then(SolutionStore::scratch_folder).map(Path::to_path_buf);
        let scratch = scratch.or_else(behind).unwrap_or_else(fs::temporary_folder);
        Store { held: Mutex::default(), ended: Condvar::new(), backing, scratch }
    }

    /// A store with these solutions, the same folder and no backing store.
    pub fn holding(&self, solutions: Vec<(Key, Arc<Solution>)>) -> Store {
        let solutions = solutions.into_iter().map(|(key, solution)| (key, (0, solution))).collect();
        let held = Mutex::new(Entries { solutions, ..Entries::default() });
        Store { held, ended: Condvar::new(), backing: None, scratch: self.scratch.clone() }
    }

    /// The folder for data that does not fit in memory.
    pub fn scratch(&self) -> &PathBuf {
        &self.scratch
    }

    /// The solution stored under `key`, with its layers moved to disk if required.
    ///
    /// # Errors
    /// If a solution in memory must be moved to disk, and the disk fails.
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
                let found = self.backing.as_deref().map_or(Ok(None), |backing| look_up(backing, key, on_disk));
                // The solution is computed instead.
                let found = found.unwrap_or_else(|error| {
                    self.lock().failure = Some(error);
                    None
                });
                Ok(found.map(|solution| self.hold(*key, Arc::new(solution), false)))
            }
        }
    }

    /// Whether a solution is stored under `key`; its file may still turn out to be damaged.
    pub fn has(&self, key: &Key) -> bool {
        self.lock().solutions.contains_key(key)
            || self.backing.as_deref().is_some_and(|backing| backing.contains(&EntryKey::of(key)))
    }

    /// Starts the computation of a solution. If another thread is computing it, waits for it if `may_wait`, otherwise
    /// computes it a second time (the bits are the same, and the first result is kept). A thread must not wait if the
    /// solution may be computed further down its own stack, as on the threads of the pool that solves it.
    ///
    /// # Errors
    /// If `progress` is cancelled during the wait.
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
        Making { store: self, key, marked }
    }

    /// Starts the computation of a solution, whether it is stored or not.
    pub fn begin_again(&self, key: &Key) -> Begun<'_> {
        Begun::Make(self.making(*key, false))
    }

    /// The backing store.
    pub(super) fn backing(&self) -> Option<&dyn SolutionStore> {
        self.backing.as_deref()
    }

    /// Records a failure of the backing store.
    pub(super) fn set_failure(&self, error: Error) {
        self.lock().failure = Some(error);
    }

    /// Number of solutions computed, without reused ones.
    pub fn made(&self) -> u64 {
        self.lock().made
    }

    /// The latest failure of the backing store.
    pub fn failure(&self) -> Option<Error> {
        self.lock().failure.clone()
    }

    /// Memory of the solutions, in bytes.
    pub fn memory(&self) -> u64 {
        self.lock().solutions.values().map(|(_, solution)| solution.memory()).sum()
    }

    /// Drops solutions from memory, the least recently used first, until those not in `needed` take at most `allowed`
    /// bytes.
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

    /// The data is consistent even if a thread panicked with the lock: solutions are inserted as a whole.
    fn lock(&self) -> MutexGuard<'_, Entries> {
        self.held.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The solution that `store` has for a content key, verified; `None` if it has none. A damaged entry is removed.
///
/// # Errors
/// If the store fails or its entry is damaged.
pub(super) fn look_up(store: &dyn SolutionStore, key: &Key, on_disk: bool) -> Result<Option<Solution>> {
    let key = EntryKey::of(key);
    let name = store.name(&key);
    let bytes = match store.get(&key) {
        Ok(Some(bytes)) => bytes,
        Ok(None) => return Ok(None),
        Err(cause) => return Err(Error::file("read the stored solution", &name, &cause)),
    };
    entry::read(bytes, &name, &key.0, on_disk).map(Some).inspect_err(|_| {
        // If it cannot be removed, it is detected as damaged again.
        let _ = store.remove(&key);
    })
}

/// Puts a solution into `store`.
///
/// # Errors
/// If the store fails.
pub(super) fn store(store: &dyn SolutionStore, key: &Key, solution: &Solution) -> Result<()> {
    let key = EntryKey::of(key);
    let put = store.put(&key, &Entry::new(&key, solution));
    put.map_err(|cause| file::explain("store the solution", &store.name(&key), &cause))
}
