//! A pool of threads: those of the system, or those that a host lends.

use orogen_grid::error::{Error, ErrorKind, Result};
use rayon::{ThreadPool, ThreadPoolBuildError};

#[cfg(target_family = "wasm")]
mod lent;
#[cfg(not(target_family = "wasm"))]
mod system;

#[cfg(target_family = "wasm")]
use lent as host;
#[cfg(target_family = "wasm")]
pub use lent::lend_thread;
#[cfg(not(target_family = "wasm"))]
use system as host;

/// A thread pool. Without threads, all work runs on the calling thread.
#[derive(Debug)]
pub struct Pool {
    threads: Option<ThreadPool>,
}

impl Pool {
    /// Starts this many threads; `None` uses the number of cores, or none of a host that lends threads.
    ///
    /// # Errors
    /// If the system cannot start them.
    pub fn new(threads: Option<usize>) -> Result<Pool> {
        let refused = |cause: ThreadPoolBuildError| {
            Error::new(ErrorKind::Request, format!("cannot start the requested threads: {cause}"))
        };
        Ok(Pool { threads: host::pool(threads).map_err(refused)? })
    }

    /// Runs work on the threads of the pool.
    pub fn install<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        match &self.threads {
            Some(threads) => threads.install(work),
            None => work(),
        }
    }

    /// Number of threads.
    #[must_use]
    pub fn threads(&self) -> usize {
        self.threads.as_ref().map_or(1, ThreadPool::current_num_threads)
    }

    /// Runs work on a new thread outside of the pool, so it may wait. On a host that lends threads it runs on the
    /// calling thread, before this returns.
    ///
    /// # Errors
    /// If the system cannot start it.
    pub fn start(work: impl FnOnce() + Send + 'static) -> Result<()> {
        host::start(work).map_err(|cause| Error::new(ErrorKind::Request, format!("cannot start a thread: {cause}")))
    }

    /// Whether the calling thread belongs to the pool. Every thread belongs to a pool without threads.
    #[must_use]
    pub fn is_current(&self) -> bool {
        self.threads.as_ref().is_none_or(|threads| threads.current_thread_index().is_some())
    }
}
