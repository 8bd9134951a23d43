//! Threads that a host lends.

use std::collections::VecDeque;
use std::convert::Infallible;
use std::sync::{Condvar, Mutex, PoisonError};

use rayon::{ThreadBuilder, ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};

/// Threads that pools have asked for, and that nobody has lent yet.
static ASKED: Mutex<VecDeque<ThreadBuilder>> = Mutex::new(VecDeque::new());
static MORE: Condvar = Condvar::new();

/// Lends the calling thread to the pools of this process, one after another. A pool waits for the threads that it has
/// asked for. Never returns.
#[doc(hidden)]
pub fn lend_thread() -> ! {
    loop {
        let asked = ASKED.lock().unwrap_or_else(PoisonError::into_inner);
        let asked = MORE.wait_while(asked, |asked| asked.is_empty());
        let thread = asked.unwrap_or_else(PoisonError::into_inner).pop_front();
        if let Some(thread) = thread {
            thread.run();
        }
    }
}

pub fn pool(threads: Option<usize>) -> Result<Option<ThreadPool>, ThreadPoolBuildError> {
    let Some(threads) = threads.filter(|threads| *threads > 0) else { return Ok(None) };
    let ask = |thread| {
        ASKED.lock().unwrap_or_else(PoisonError::into_inner).push_back(thread);
        MORE.notify_one();
        Ok(())
    };
    ThreadPoolBuilder::new().num_threads(threads).spawn_handler(ask).build().map(Some)
}

pub fn start(work: impl FnOnce()) -> Result<(), Infallible> {
    work();
    Ok(())
}
