//! The desk, where answers are computed: each once for all who wait for it, at most as many at a time as there are
//! threads, for at most a fixed number of waiting requests.

use std::collections::HashMap;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use axum::body::Bytes;
use axum::http::StatusCode;
use orogen::Progress;
use tokio::sync::{OwnedSemaphorePermit, Semaphore, watch};

use crate::cache::TileCache;
use crate::refusal::Refusal;

/// The result of a piece of work.
type Outcome = Result<Bytes, Refusal>;

/// A piece of work.
pub type Work = Box<dyn FnOnce(&Progress) -> Outcome + Send>;

/// What becomes of a piece of work and of its result.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Keep {
    /// The result is a tile or a window, of which a client may read parts: it is kept in the cache.
    Tile,
    /// The result is only sent.
    Nothing,
    /// The work goes on if nobody waits for it any more, because later requests need it.
    Work,
}

/// Work that is waiting or running.
struct Flight {
    progress: Progress,
    outcome: watch::Sender<Option<Outcome>>,
    keep: Keep,
}

/// What was done so far.
#[derive(Default)]
pub struct Counts {
    /// Answers from the cache.
    pub hits: AtomicU64,
    /// Finished work.
    pub made: AtomicU64,
    /// Work that was cancelled, because nobody waited for it any more.
    pub cancelled: AtomicU64,
    /// Requests that were refused, because too many others were waiting.
    pub refused: AtomicU64,
}

/// The desk of a server.
pub struct Desk {
    flights: Mutex<HashMap<String, Arc<Flight>>>,
    cache: Mutex<TileCache>,
    workers: Arc<Semaphore>,
    threads: usize,
    seats: Arc<Semaphore>,
    pub counts: Counts,
}

/// Data under these locks is consistent at any time, also after a panic of another thread.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Desk {
    /// A desk with this many workers, for at most `queue` requests that wait beside those that are worked on.
    pub fn new(threads: usize, queue: usize, cache: usize) -> Desk {
        Desk {
            flights: Mutex::default(),
            cache: Mutex::new(TileCache::new(cache)),
            workers: Arc::new(Semaphore::new(threads)),
            threads,
            seats: Arc::new(Semaphore::new((threads + queue).min(Semaphore::MAX_PERMITS))),
            counts: Counts::default(),
        }
    }

    /// A place among the requests that wait.
    ///
    /// # Errors
    /// If there is none.
    pub fn seat(&self) -> Result<OwnedSemaphorePermit, Refusal> {
        Arc::clone(&self.seats).try_acquire_owned().map_err(|_| {
            self.counts.refused.fetch_add(1, Ordering::Relaxed);
            Refusal::busy("too many requests are waiting; send the request again later, or raise --queue")
        })
    }

    /// A tile of the cache.
    pub fn cached(&self, key: &str) -> Option<Bytes> {
        let found = lock(&self.cache).get(key)?;
        self.counts.hits.fetch_add(1, Ordering::Relaxed);
        Some(found)
    }

    /// The result of the work with this key, which is done once for all who ask meanwhile. If this future is dropped
    /// and nobody else waits, the work is cancelled.
    pub async fn get(self: &Arc<Desk>, key: String, keep: Keep, work: impl FnOnce() -> Work) -> Outcome {
        let mut receiver = {
            let mut flights = lock(&self.flights);
            if let Some(bytes) = self.cached(&key) {
                return Ok(bytes);
            }
            match flights.get(&key) {
                Some(flight) => flight.outcome.subscribe(),
                None => {
                    let (outcome, receiver) = watch::channel(None);
                    let flight = Arc::new(Flight { progress: Progress::none(), outcome, keep });
                    flights.insert(key.clone(), Arc::clone(&flight));
                    tokio::spawn(Arc::clone(self).fly(key, flight, work()));
                    receiver
                }
            }
        };
        let ended = || {
            let message = "the work ended without a result; this is a bug";
            Refusal { status: StatusCode::INTERNAL_SERVER_ERROR, message: message.into() }
        };
        let outcome = receiver.wait_for(Option::is_some).await;
        outcome.map_err(|_| ended())?.clone().unwrap_or_else(|| Err(ended()))
    }

    /// Does the work, unless nobody waits for it any more.
    async fn fly(self: Arc<Desk>, key: String, flight: Arc<Flight>, work: Work) {
        let leaves = flight.keep != Keep::Work;
        let permit = loop {
            tokio::select! {
                permit = Arc::clone(&self.workers).acquire_owned() => break permit,
                () = flight.outcome.closed(), if leaves => if self.leave(&key, &flight) { return },
            }
        };
        let progress = flight.progress.clone();
        let mut running = tokio::task::spawn_blocking(move || {
            let _permit = permit;
            work(&progress)
        });
        let outcome = loop {
            tokio::select! {
                outcome = &mut running => break outcome,
                () = flight.outcome.closed(), if leaves && !flight.progress.is_cancelled() => {
                    if self.leave(&key, &flight) {
                        flight.progress.cancel();
                    }
                }
            }
        };
        let outcome = outcome.unwrap_or_else(|cause| {
            Err(Refusal { status: StatusCode::INTERNAL_SERVER_ERROR, message: format!("a bug: {cause}") })
        });
        self.counts.made.fetch_add(1, Ordering::Relaxed);
        let mut flights = lock(&self.flights);
        if let (Keep::Tile, Ok(bytes)) = (flight.keep, &outcome) {
            lock(&self.cache).insert(key.clone(), bytes.clone());
        }
        if flights.get(&key).is_some_and(|other| Arc::ptr_eq(other, &flight)) {
            flights.remove(&key);
        }
        flight.outcome.send_replace(Some(outcome));
    }

    /// Removes work for which nobody waits; `false` if somebody does.
    fn leave(&self, key: &str, flight: &Flight) -> bool {
        // Others only join under this lock.
        let mut flights = lock(&self.flights);
        let is_left = flight.outcome.receiver_count() == 0;
        if is_left {
            flights.remove(key);
            self.counts.cancelled.fetch_add(1, Ordering::Relaxed);
        }
        is_left
    }

    /// Cancels all work.
    pub fn cancel(&self) {
        lock(&self.flights).values().for_each(|flight| flight.progress.cancel());
    }

    /// Number of workers that are busy.
    pub fn busy(&self) -> usize {
        self.threads - self.workers.available_permits().min(self.threads)
    }

    /// Number of pieces of work that are waiting or running.
    pub fn pending(&self) -> usize {
        lock(&self.flights).len()
    }

    /// Bytes in the cache.
    pub fn cache_bytes(&self) -> usize {
        lock(&self.cache).bytes()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::AtomicUsize;
    use std::sync::mpsc;

    fn runtime() -> tokio::runtime::Runtime {
        tokio::runtime::Builder::new_multi_thread().worker_threads(1).build().unwrap()
    }

    /// Work that waits for a message, and returns it.
    fn waiting(receiver: mpsc::Receiver<&'static str>, started: Arc<AtomicUsize>) -> Work {
        Box::new(move |_| {
            started.fetch_add(1, Ordering::Relaxed);
            Ok(Bytes::from_static(receiver.recv().unwrap().as_bytes()))
        })
    }

    #[test]
    fn work_is_done_once_for_all_who_wait_and_then_found_in_the_cache() {
        runtime().block_on(async {
            let desk = Arc::new(Desk::new(2, 4, 1 << 20));
            let started = Arc::new(AtomicUsize::new(0));
            let (sender, receiver) = mpsc::channel();
            let mut receiver = Some(receiver);
            let mut asked = Vec::new();
            for _ in 0..5 {
                let (desk, started, receiver) = (Arc::clone(&desk), Arc::clone(&started), receiver.take());
                let work = move || waiting(receiver.unwrap(), started);
                asked.push(Box::pin(async move { desk.get("a".into(), Keep::Tile, work).await }));
            }
            // All of them join before the work ends.
            for future in &mut asked {
                tokio::select! {
                    biased;
                    _ = future => panic!("nothing is done yet"),
                    () = std::future::ready(()) => {}
                }
            }
            sender.send("tile").unwrap();
            for future in asked {
                assert_eq!(future.await.unwrap(), "tile");
            }
            assert_eq!((started.load(Ordering::Relaxed), desk.pending()), (1, 0));
            assert_eq!(desk.cached("a").unwrap(), "tile");
            let again = desk.get("a".into(), Keep::Tile, || panic!("it is in the cache")).await;
            assert_eq!(again.unwrap(), "tile");
        });
    }

    #[test]
    fn work_that_nobody_waits_for_is_cancelled_and_leaves_nothing() {
        runtime().block_on(async {
            let desk = Arc::new(Desk::new(1, 4, 1 << 20));
            let (started, begun) = tokio::sync::oneshot::channel();
            let (ended, end) = tokio::sync::oneshot::channel();
            let work = move || -> Work {
                Box::new(move |progress: &Progress| {
                    started.send(()).unwrap();
                    while !progress.is_cancelled() {
                        std::thread::yield_now();
                    }
                    ended.send(()).unwrap();
                    Ok(Bytes::new())
                })
            };
            let mut request = Box::pin(desk.get("a".into(), Keep::Tile, work));
            tokio::select! {
                _ = &mut request => panic!("it never ends by itself"),
                begun = begun => begun.unwrap(),
            }
            // Work that waits in the queue is never begun.
            let mut queued =
                Box::pin(desk.get("b".into(), Keep::Nothing, || Box::new(|_| panic!("nobody waits for it"))));
            tokio::select! {
                biased;
                _ = &mut queued => panic!("the only worker is busy"),
                () = std::future::ready(()) => {}
            }
            drop(queued);
            drop(request);
            end.await.unwrap();
            while desk.pending() > 0 || desk.busy() > 0 {
                tokio::task::yield_now().await;
            }
            assert_eq!(desk.counts.cancelled.load(Ordering::Relaxed), 2);
            // The desk is free for others.
            let next = desk.get("d".into(), Keep::Nothing, || Box::new(|_| Ok(Bytes::from_static(b"d")))).await;
            assert_eq!(next.unwrap(), "d");
        });
    }

    #[test]
    fn a_full_queue_is_a_refusal_and_seats_come_back() {
        let desk = Desk::new(1, 2, 0);
        let seats: Vec<_> = (0..3).map(|_| desk.seat().unwrap()).collect();
        let refusal = desk.seat().unwrap_err();
        assert_eq!(refusal.status, StatusCode::SERVICE_UNAVAILABLE);
        drop(seats);
        assert!(desk.seat().is_ok());
    }
}
