//! Sessions: threads, solutions and memory that worlds share.

use crate::device::Device;
use crate::plan::key::Key;
use crate::store::kept::Kept;
use crate::store::solution_store::SolutionStore;
use crate::store::solutions::Store;
use orogen_grid::error::{Error, Result};
use orogen_ops::budget::Budget;
use orogen_ops::op::Solution;
use orogen_ops::pool::Pool;
use std::path::PathBuf;
use std::sync::Arc;

/// Options of computation. They do not change the terrain.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// Number of threads; `None` uses the number of cores.
    pub threads: Option<usize>,
    /// Memory limit, in bytes, for all concurrent requests and reservations of callers. Larger solutions are kept on
    /// disk.
    pub memory: Budget,
    /// The store of solutions and tiles of levels for later runs: a [`FolderStore`](crate::FolderStore), a
    /// [`MemoryStore`](crate::MemoryStore), or a [store of your own](SolutionStore). `None` keeps them for this session
    /// only.
    pub store: Option<Arc<dyn SolutionStore>>,
    /// The folder for data that does not fit in memory; `None` uses the folder of the store, otherwise the system's
    /// temporary folder. No files remain in it, even after a kill.
    pub scratch: Option<PathBuf>,
    /// Memory limit, in bytes, for grids of expensive filters that are kept for later requests. `None` means 256 MiB,
    /// or a quarter of the memory limit if that is less; 0 keeps none.
    pub kept_grids: Option<u64>,
}

/// Threads, solutions and a memory budget, shared by any number of worlds and concurrent requests. Clones share them
/// too.
///
/// - Requests share one pool of threads.
/// - A solution is computed once, even for concurrent requests, and is reused by every world with the same nodes: after
///   an edit of a recipe, only nodes that depend on the edited node are solved again.
/// - Grids of expensive filters are kept as long as there is memory.
/// - A tile of a coarse level of a levelled op is made once, even for concurrent requests. It is kept as long as there
///   is memory, and in the store.
/// - Concurrent requests together never exceed the [budget](Options::memory): requests that do not fit wait for others.
///
/// ```
/// use orogen_engine::{Options, Session, Window, presets};
///
/// let session = Session::new(Options { threads: Some(2), ..Options::default() })?;
/// let mut recipe = presets::find("classic").ok_or("no such preset")?.recipe()?;
/// let before = session.open(recipe.clone())?.window("height", &Window::new(64, 64, 30.0))?;
/// // Nothing in this recipe reads the sea level.
/// recipe.world.sea_level = 120.0;
/// assert_eq!(session.open(recipe)?.window("height", &Window::new(64, 64, 30.0))?, before);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct Session {
    pub(crate) pool: Arc<Pool>,
    pub(crate) kept: Arc<Kept>,
    pub(crate) budget: Budget,
    pub(crate) device: Option<Arc<dyn Device>>,
    /// Results of previews with the device.
    pub(crate) previews: Arc<Kept>,
    /// Results of drafts.
    pub(crate) drafts: Arc<Kept>,
    pub(crate) is_draft: bool,
}

/// Default of [`Options::kept_grids`], in bytes.
const KEPT_GRIDS: u64 = 256 << 20;

/// Memory limit of tiles of levels, in bytes; with a memory limit, at most an eighth of it.
const LEVEL_TILES: u64 = 128 << 20;

impl Session {
    /// Starts the threads.
    ///
    /// # Errors
    /// If no threads can be started.
    pub fn new(options: Options) -> Result<Session> {
        let pool = Pool::new(options.threads)?;
        let limit = options.memory.limit();
        let grids = options.kept_grids.unwrap_or(limit.map_or(KEPT_GRIDS, |limit| KEPT_GRIDS.min(limit / 4)));
        let level_tiles = limit.map_or(LEVEL_TILES, |limit| LEVEL_TILES.min(limit / 8));
        let kept = Kept::new(Store::new(options.store, options.scratch), grids, level_tiles);
        Ok(Session {
            pool: Arc::new(pool),
            budget: options.memory.clone(),
            device: None,
            previews: Arc::new(kept.emptied()),
            drafts: Arc::new(kept.emptied()),
            kept: Arc::new(kept),
            is_draft: false,
        })
    }

    /// The same session with a device for previews. The device computes windows in place of the processor where it can
    /// and where exact bits are not needed. The processor still computes stored solutions, tiles of levels, kept grids,
    /// points, objects and volumes. Results of the device are kept in memory for later windows of sessions with the
    /// same device.
    #[doc(hidden)]
    #[must_use]
    pub fn with_device(&self, device: Arc<dyn Device>) -> Session {
        let kept = || Arc::new(self.previews.emptied());
        Session { device: Some(device), previews: kept(), drafts: kept(), ..self.clone() }
    }

    /// The same session for drafts: its device also runs chaotic solvers. Their terrain on the device is as realistic
    /// as the processor's, but has other rivers. Without a device this has no effect.
    #[doc(hidden)]
    #[must_use]
    pub fn drafting(&self) -> Session {
        Session { is_draft: true, ..self.clone() }
    }

    /// The same session without its device: the processor computes everything.
    #[doc(hidden)]
    #[must_use]
    pub fn without_device(&self) -> Session {
        Session { device: None, ..self.clone() }
    }

    /// The memory budget, which callers can reserve from: see [`Budget::reserve`].
    #[must_use]
    pub fn budget(&self) -> &Budget {
        &self.budget
    }

    /// Runs work on a separate thread, for callers that must not wait, such as a user interface. Cancel it with the
    /// [`Progress`](orogen_grid::progress::Progress) that it uses. Without threads the work is done before this
    /// returns.
    ///
    /// ```
    /// use orogen_engine::{Options, Session, Window, presets};
    /// use std::sync::mpsc;
    ///
    /// let session = Session::new(Options::default())?;
    /// let recipe = presets::find("classic").ok_or("no such preset")?.recipe()?;
    /// let (sender, receiver) = mpsc::channel();
    /// session.start(move |session| {
    ///     let heights = session.open(recipe).and_then(|world| world.window("height", &Window::new(64, 64, 30.0)));
    ///     // The receiver may be gone.
    ///     sender.send(heights).ok();
    /// })?;
    /// assert_eq!(receiver.recv()??.data().len(), 64 * 64);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the system cannot start a thread.
    pub fn start(&self, work: impl FnOnce(&Session) + Send + 'static) -> Result<()> {
        let session = self.clone();
        Pool::start(move || work(&session))
    }

    /// Runs work on the session's threads, and returns once it is done.
    pub fn install<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        self.pool.install(work)
    }

    /// Number of threads.
    #[must_use]
    pub fn threads(&self) -> usize {
        self.pool.threads()
    }

    /// Number of solutions computed so far, without reused ones.
    #[must_use]
    pub fn solutions_made(&self) -> u64 {
        self.kept.store.made()
    }

    /// The latest failure of the [store](Options::store), or a damaged entry that it had. Failures do not stop work: a
    /// solution that cannot be read is solved again, and one that cannot be stored stays in memory.
    #[must_use]
    pub fn store_failure(&self) -> Option<Error> {
        self.kept.store.failure()
    }

    /// Number of tiles of the levels of [levelled ops](orogen_ops::op::Levelled) made so far, without reused ones.
    #[must_use]
    pub fn level_tiles_made(&self) -> u64 {
        self.kept.level_tiles.made()
    }

    /// Number of filters that were not applied because their grids were kept from an earlier request.
    #[must_use]
    pub fn filters_found(&self) -> u64 {
        self.kept.grids.found()
    }

    /// Memory of kept solutions, grids and tiles, in bytes, without the memory of running requests.
    #[must_use]
    pub fn kept_memory(&self) -> u64 {
        [&self.kept, &self.previews, &self.drafts].iter().fold(0, |sum, kept| kept.memory().saturating_add(sum))
    }

    /// The same threads and memory without any solutions and without a store for later runs.
    #[must_use]
    pub fn with_empty_store(&self) -> Session {
        self.with_solutions(Vec::new())
    }

    /// The same threads and memory with the given solutions and without a store for later runs.
    pub(crate) fn with_solutions(&self, solved: Vec<(Key, Arc<Solution>)>) -> Session {
        let nothing = || Arc::new(Kept::new(self.kept.store.holding(Vec::new()), 0, 0));
        let kept = Arc::new(self.kept.with_solutions(solved));
        Session { kept, previews: nothing(), drafts: nothing(), ..self.clone() }
    }

    /// Drops kept grids and solutions, the least recently used first, until those not in `needed` fit together with the
    /// memory in use.
    pub(crate) fn make_room(&self, needed: &[Key]) {
        if let Some(unused) = self.budget.unused() {
            let left = self.kept.make_room(unused, needed);
            let left = self.previews.make_room(left, &[]);
            self.drafts.make_room(left, &[]);
        }
    }
}
