//! What worlds share: threads, solutions, memory.

use crate::budget::Budget;
use crate::op::Solution;
use crate::plan::key::Key;
use crate::pool::Pool;
use crate::store::cache::Cache;
use crate::store::grids::GridStore;
use crate::store::solutions::Store;
use orogen_grid::error::Result;
use std::path::PathBuf;
use std::sync::Arc;

/// How worlds are worked on. None of it changes a bit of the terrain.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// Threads; `None` takes as many as the machine has cores.
    pub threads: Option<usize>,
    /// Bytes that all requests at the same time may need together, with what callers hold. Solutions that are too large for it are kept on disk.
    pub memory: Budget,
    /// Where solutions are found again by later runs; `None` keeps none.
    pub cache: Option<Cache>,
    /// The folder for what does not fit in memory; `None` takes the cache's, or else the system's for temporary files. Nothing
    /// stays in it, not even after a kill.
    pub scratch: Option<PathBuf>,
    /// Bytes of grids of expensive filters that are kept for later requests. `None` takes 256 MiB, and a quarter of the memory limit if that is less; 0 keeps
    /// none.
    pub kept_grids: Option<u64>,
}

/// Threads, solutions and a memory budget, shared by any number of worlds and of requests at the same time. Clones share them, too.
///
/// - Requests take turns on one pool of threads.
/// - A solution is made once, however many requests want it at the same time, and found again by every world that has the same nodes: after an edit of a
///   recipe only what reads the edited node is solved again.
/// - The grids of expensive filters are kept, as long as there is memory for them.
/// - Requests at the same time never need more memory together than the [budget](Options::memory) allows: those that do not fit wait for the others.
///
/// ```
/// use orogen_engine::{Options, Session, Window, presets};
///
/// let session = Session::new(Options { threads: Some(2), ..Options::default() })?;
/// let mut recipe = presets::find("hills").ok_or("no such preset")?.recipe()?;
/// let before = session.open(recipe.clone())?.window("height", &Window::new(64, 64, 30.0))?;
/// // Nothing in this recipe reads the sea level.
/// recipe.world.sea_level = 120.0;
/// assert_eq!(session.open(recipe)?.window("height", &Window::new(64, 64, 30.0))?, before);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct Session {
    pub(crate) pool: Arc<Pool>,
    pub(crate) store: Arc<Store>,
    pub(crate) grids: Arc<GridStore>,
    pub(crate) budget: Budget,
}

/// Bytes of grids kept where nobody says.
const KEPT_GRIDS: u64 = 256 << 20;

impl Session {
    /// Starts the threads.
    ///
    /// # Errors
    /// If no threads can be started.
    pub fn new(options: Options) -> Result<Session> {
        let pool = Pool::new(options.threads)?;
        let most = options.memory.limit().map_or(KEPT_GRIDS, |limit| KEPT_GRIDS.min(limit / 4));
        Ok(Session {
            pool: Arc::new(pool),
            store: Arc::new(Store::new(options.cache, options.scratch)),
            grids: Arc::new(GridStore::new(options.kept_grids.unwrap_or(most))),
            budget: options.memory,
        })
    }

    /// The memory that requests share with what callers hold: see [`Budget::reserve`].
    pub fn budget(&self) -> &Budget {
        &self.budget
    }

    /// How many threads work.
    pub fn threads(&self) -> usize {
        self.pool.threads()
    }

    /// How many solutions were made so far, those found again not counted.
    pub fn solutions_made(&self) -> u64 {
        self.store.made()
    }

    /// How many filters were not applied since their grids were kept from an earlier request.
    pub fn filters_found(&self) -> u64 {
        self.grids.found()
    }

    /// Bytes of the solutions and grids that are kept in memory, beside what requests need.
    pub fn kept_memory(&self) -> u64 {
        self.store.memory().saturating_add(self.grids.memory())
    }

    /// The same threads and memory with no solutions yet, and none that are kept for later runs.
    pub fn with_empty_store(&self) -> Session {
        self.with_solutions(Vec::new())
    }

    /// The same threads and memory with solutions of its own: those given, and none that are kept for later.
    pub(crate) fn with_solutions(&self, solved: Vec<(Key, Arc<Solution>)>) -> Session {
        Session {
            store: Arc::new(Store::holding(solved, self.store.scratch().clone())),
            grids: Arc::new(GridStore::new(0)),
            ..self.clone()
        }
    }

    /// Lets go of kept grids and of solutions in memory, the longest unused first, until those not among `needed` fit beside what is in use.
    pub(crate) fn make_room(&self, needed: &[Key]) {
        if let Some(unused) = self.budget.unused() {
            self.store.make_room(unused, needed);
            self.grids.make_room(unused.saturating_sub(self.store.memory()));
        }
    }
}
