//! The threads that work is shared out to.

use orogen_grid::error::Result;
#[cfg(all(feature = "threads", not(target_family = "wasm")))]
use orogen_grid::error::{Error, ErrorKind};

/// Whether other threads can exist: where not, nobody may wait for one.
pub const HAS_THREADS: bool = cfg!(all(feature = "threads", not(target_family = "wasm")));

/// A pool of threads. On a host without threads (WebAssembly), and without the feature `threads`, it has none, and all work is done on the calling thread.
#[derive(Debug)]
pub struct Pool {
    #[cfg(all(feature = "threads", not(target_family = "wasm")))]
    threads: rayon::ThreadPool,
}

#[cfg(all(feature = "threads", not(target_family = "wasm")))]
impl Pool {
    /// Starts so many threads; `None` takes as many as the machine has cores.
    ///
    /// # Errors
    /// If the system refuses.
    pub fn new(threads: Option<usize>) -> Result<Pool> {
        let built = rayon::ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0)).build();
        let refused = |cause| Error::new(ErrorKind::Request, format!("cannot start the threads asked for: {cause}"));
        Ok(Pool { threads: built.map_err(refused)? })
    }

    /// Does work that is shared out to the threads.
    pub fn install<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        self.threads.install(work)
    }

    /// How many threads work.
    pub fn threads(&self) -> usize {
        self.threads.current_num_threads()
    }

    /// Whether the calling thread is one of the pool's.
    pub fn is_current(&self) -> bool {
        self.threads.current_thread_index().is_some()
    }
}

#[cfg(not(all(feature = "threads", not(target_family = "wasm"))))]
impl Pool {
    /// Starts no thread, however many are asked for: the calling one does all the work.
    ///
    /// # Errors
    /// Never.
    pub fn new(_: Option<usize>) -> Result<Pool> {
        Ok(Pool {})
    }

    /// Does work on the calling thread.
    pub fn install<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        work()
    }

    /// How many threads work.
    pub fn threads(&self) -> usize {
        1
    }

    /// Whether the calling thread is one of the pool's: there is no other.
    pub fn is_current(&self) -> bool {
        true
    }
}
