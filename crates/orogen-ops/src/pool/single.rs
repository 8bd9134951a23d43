//! A pool without threads.

use orogen_grid::error::Result;

/// A thread pool. On a host without threads (WebAssembly), or without the feature `threads`, it is empty, and all work
/// runs on the calling thread.
#[derive(Debug)]
pub struct Pool {}

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
