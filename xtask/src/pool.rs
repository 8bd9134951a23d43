//! Work that is done in parallel.

use std::num::NonZero;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread::{self, ScopedJoinHandle};

use crate::failure::{Failure, Result};
use crate::output;

/// The number of items that are worked on at once: one per core, and at least two, because some items wait.
pub fn workers() -> usize {
    thread::available_parallelism().map_or(1, NonZero::get).max(2)
}

/// Works on all items in order, as many at once as there are workers. After a failure no other item is started. Returns
/// all failures.
pub fn run<T: Send>(items: Vec<T>, work: impl Fn(T) -> Result + Sync) -> Result {
    let (log, failed, waiting) = (output::log(), AtomicBool::new(false), Mutex::new(items.into_iter()));
    let worker = || {
        output::set_log(log.clone());
        let next = || waiting.lock().unwrap_or_else(PoisonError::into_inner).next();
        while !failed.load(Ordering::Relaxed)
            && let Some(item) = next()
        {
            work(item).inspect_err(|_| failed.store(true, Ordering::Relaxed))?;
        }
        Ok(())
    };
    let ended = |thread: ScopedJoinHandle<Result>| {
        thread.join().unwrap_or_else(|_| Err(Failure::new("a thread of side-by-side work panicked")))
    };
    let results: Vec<Result> = thread::scope(|scope| {
        let threads: Vec<_> = (0..workers()).map(|_| scope.spawn(worker)).collect();
        threads.into_iter().map(ended).collect()
    });
    let failures: Vec<String> =
        results.iter().filter_map(|result| Some(result.as_ref().err()?.message().to_owned())).collect();
    if failures.is_empty() { Ok(()) } else { Err(Failure::new(failures.join("\n"))) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::AtomicUsize;

    #[test]
    fn every_item_is_done_once() {
        let sum = AtomicUsize::new(0);
        run((1..=100).collect(), |item| {
            sum.fetch_add(item, Ordering::Relaxed);
            Ok(())
        })
        .expect("nothing fails");
        assert_eq!(sum.into_inner(), 5050);
    }

    #[test]
    fn a_failure_is_returned_and_ends_the_work() {
        let done = AtomicUsize::new(0);
        let failure = run((0..1000).collect(), |item| {
            done.fetch_add(1, Ordering::Relaxed);
            Err(Failure::new(format!("item {item} broke")))
        })
        .expect_err("every item fails");
        assert!(failure.message().contains("item 0 broke"), "{}", failure.message());
        assert!(done.into_inner() <= workers());
    }
}
