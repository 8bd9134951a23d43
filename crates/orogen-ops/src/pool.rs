//! The thread pool.

use orogen_grid::error::Result;
#[cfg(all(feature = "threads", not(target_family = "wasm")))]
use orogen_grid::error::{Error, ErrorKind};

/// Whether there can be several threads. Otherwise no thread may wait for another one.
pub const HAS_THREADS: bool = cfg!(all(feature = "threads", not(target_family = "wasm")));

/// A thread pool. On a host without threads (WebAssembly), or without the feature `threads`, it is empty, and all work
/// runs on the calling thread.
#[derive(Debug)]
pub struct Pool {
    #[cfg(all(feature = "threads", not(target_family = "wasm")))]
    threads: rayon::ThreadPool,
}

#[cfg(all(feature = "threads", not(target_family = "wasm")))]
impl Pool {
    /// Starts this many threads; `None` uses the number of cores.
    ///
    /// # Errors
    /// If the system cannot start them.
    pub fn new(threads: Option<usize>) -> Result<Pool> {
        let built = rayon::ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0)).build();
        let refused = |cause| Error::new(ErrorKind::Request, format!("cannot start the requested threads: {cause}"));
        Ok(Pool { threads: built.map_err(refused)? })
    }

    /// Runs work on the threads of the pool.
    pub fn install<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        self.threads.install(work)
    }

    /// Number of threads.
    #[must_use]
    pub fn threads(&self) -> usize {
        self.threads.current_num_threads()
    }

    /// Runs work on a new thread outside of the pool, so it may wait.
    ///
    /// # Errors
    /// If the system cannot start it.
    pub fn start(work: impl FnOnce() + Send + 'static) -> Result<()> {
        let started = std::thread::Builder::new().name("orogen-request".into()).spawn(work);
        let refused = |cause| Error::new(ErrorKind::Request, format!("cannot start a thread: {cause}"));
        started.map(drop).map_err(refused)
    }

    /// Whether the calling thread belongs to the pool.
    #[must_use]
    pub fn is_current(&self) -> bool {
        self.threads.current_thread_index().is_some()
    }
}

#[cfg(not(all(feature = "threads", not(target_family = "wasm"))))]
impl Pool {
    /// Starts no threads: the calling thread does all the work.
    ///
    /// # Errors
    /// Never.
    pub fn new(_: Option<usize>) -> Result<Pool> {
        Ok(Pool {})
    }

    /// Runs work on the calling thread.
    pub fn install<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        work()
    }

    /// Number of threads.
    #[must_use]
    pub fn threads(&self) -> usize {
        1
    }

    /// Runs work on the calling thread, before it returns.
    ///
    /// # Errors
    /// Never.
    pub fn start(work: impl FnOnce() + Send + 'static) -> Result<()> {
        work();
        Ok(())
    }

    /// Whether the calling thread belongs to the pool: always, because there is no other.
    #[must_use]
    pub fn is_current(&self) -> bool {
        true
    }
}
