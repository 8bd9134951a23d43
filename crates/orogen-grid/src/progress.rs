//! Progress of work, and cancellation.
//!
//! A [`Progress`] belongs to one piece of work. The code that does the work declares its amount with
//! [`Progress::expect`], in any unit, and counts completed work with [`Progress::advance`]. Work that consists of
//! several pieces gives each of them a weighted [part](Progress::part). The caller receives one number: the share of
//! all work that is done, which never decreases.
//!
//! ```
//! use orogen_grid::Progress;
//! use std::sync::{Arc, Mutex};
//!
//! let heard = Arc::new(Mutex::new(Vec::new()));
//! let told = Arc::clone(&heard);
//! let progress = Progress::new(move |share| told.lock().unwrap().push(share));
//! let [short, long] = progress.parts([1.0, 3.0]);
//! short.finish();
//! long.expect(2.0);
//! long.advance(1.0);
//! long.finish();
//! assert_eq!(*heard.lock().unwrap(), [0.25, 0.625, 1.0]);
//! ```

use crate::error::{Error, ErrorKind, Result};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

/// Progress of one piece of work, shared between the caller and the work. A clone is another handle to the same
/// progress.
#[derive(Clone, Default)]
pub struct Progress {
    piece: Arc<Node>,
}

/// Receives the share of the work that is done.
type Listener = dyn Fn(f64) + Send + Sync;

/// State shared by all pieces of a run.
#[derive(Default)]
struct Run {
    cancelled: AtomicBool,
    /// Set by code that has no [`Progress`], such as a signal handler.
    stop: OnceLock<Arc<AtomicBool>>,
    listener: Option<Box<Listener>>,
}

#[derive(Default)]
struct Node {
    run: Arc<Run>,
    /// The progress of which this piece is a part, and its weight there.
    whole: Option<(Progress, f64)>,
    count: Mutex<Count>,
}

#[derive(Debug, Default)]
struct Count {
    expected: f64,
    done: f64,
    /// The last reported share: 0 to 1, never decreasing.
    share: f64,
}

impl Progress {
    /// Progress without a listener.
    #[must_use]
    pub fn none() -> Progress {
        Progress::default()
    }

    /// Calls `listener` with the share of the work that is done, from 0 to 1, each time it increases. Calls can come
    /// from any thread, but only one at a time, and the share never decreases.
    pub fn new(listener: impl Fn(f64) + Send + Sync + 'static) -> Progress {
        let run = Run { listener: Some(Box::new(listener)), ..Run::default() };
        Progress { piece: Arc::new(Node { run: Arc::new(run), ..Node::default() }) }
    }

    /// The same progress, which is also cancelled when `flag` is set, for example by a signal handler that cannot call
    /// [`Progress::cancel`]. Only the first flag counts.
    pub fn stopped_by(self, flag: Arc<AtomicBool>) -> Progress {
        let _ = self.piece.run.stop.set(flag);
        self
    }

    /// Requests cancellation; the work ends soon with [`ErrorKind::Cancelled`].
    pub fn cancel(&self) {
        self.piece.run.cancelled.store(true, Ordering::Relaxed);
    }

    /// Whether cancellation was requested.
    #[must_use]
    pub fn is_cancelled(&self) -> bool {
        let run = &self.piece.run;
        run.cancelled.load(Ordering::Relaxed) || run.stop.get().is_some_and(|flag| flag.load(Ordering::Relaxed))
    }

    /// Returns an error if the work was cancelled.
    ///
    /// # Errors
    /// [`ErrorKind::Cancelled`] after cancellation.
    pub fn check(&self) -> Result<()> {
        match self.is_cancelled() {
            true => Err(Error::new(ErrorKind::Cancelled, "the work was cancelled")),
            false => Ok(()),
        }
    }

    /// Adds to the amount of work. Declare all of it before the first [`Progress::advance`]: if work is added later,
    /// the share stays constant until the completed work has caught up.
    pub fn expect(&self, work: f64) {
        if self.is_heard() {
            self.count().expected += work.max(0.0);
        }
    }

    /// Counts work as done, in the unit of [`Progress::expect`].
    pub fn advance(&self, work: f64) {
        if self.is_heard() {
            let mut count = self.count();
            count.done += work.max(0.0);
            let share = if count.expected > 0.0 { count.done / count.expected } else { 0.0 };
            self.report(count, share);
        }
    }

    /// [`Progress::advance`] and [`Progress::check`] in one, for loops.
    ///
    /// # Errors
    /// [`ErrorKind::Cancelled`] after cancellation.
    pub fn step(&self, work: f64) -> Result<()> {
        self.advance(work);
        self.check()
    }

    /// Counts the whole piece as done.
    pub fn finish(&self) {
        if self.is_heard() {
            self.report(self.count(), 1.0);
        }
    }

    /// A part of this work that counts as `work` when it is finished. It does not add to the
    /// [expected](Progress::expect) amount.
    #[must_use]
    pub fn part(&self, work: f64) -> Progress {
        let whole = Some((self.clone(), work.max(0.0)));
        Progress { piece: Arc::new(Node { run: Arc::clone(&self.piece.run), whole, ..Node::default() }) }
    }

    /// Divides this work into parts by weight. The sum of the weights becomes the expected amount.
    #[must_use]
    pub fn parts<const N: usize>(&self, weights: [f64; N]) -> [Progress; N] {
        weights.iter().for_each(|weight| self.expect(*weight));
        weights.map(|weight| self.part(weight))
    }

    fn is_heard(&self) -> bool {
        self.piece.run.listener.is_some()
    }

    fn count(&self) -> MutexGuard<'_, Count> {
        self.piece.count.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Reports a larger share to the parent progress or to the listener. The lock is held meanwhile, so that reports
    /// keep their order.
    fn report(&self, mut count: MutexGuard<'_, Count>, share: f64) {
        let share = share.min(1.0);
        let more = share - count.share;
        if more > 0.0 {
            count.share = share;
            match (&self.piece.whole, &self.piece.run.listener) {
                (Some((whole, weight)), _) => whole.advance(more * weight),
                (None, Some(listener)) => listener(share),
                (None, None) => {}
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A progress handle, and the list of all reported shares.
    fn heard() -> (Progress, Arc<Mutex<Vec<f64>>>) {
        let shares = Arc::new(Mutex::new(Vec::new()));
        let told = Arc::clone(&shares);
        (Progress::new(move |share| told.lock().unwrap().push(share)), shares)
    }

    #[test]
    fn work_that_becomes_known_late_never_takes_the_share_back() {
        let (progress, shares) = heard();
        progress.expect(2.0);
        progress.advance(1.0);
        progress.expect(8.0);
        (0..9).for_each(|_| progress.advance(1.0));
        progress.advance(5.0);
        assert_eq!(*shares.lock().unwrap(), [0.5, 0.6, 0.7, 0.8, 0.9, 1.0]);
    }

    #[test]
    fn a_part_counts_as_its_weight_however_much_work_it_is_in_itself() {
        let (progress, shares) = heard();
        let [first, second] = progress.parts([3.0, 1.0]);
        first.expect(1000.0);
        first.advance(500.0);
        // This step had no expected share, so nothing is reported before its end.
        second.advance(7.0);
        second.finish();
        first.advance(9000.0);
        assert_eq!(*shares.lock().unwrap(), [0.375, 0.625, 1.0]);
    }

    #[test]
    fn many_threads_at_once_are_heard_in_order() {
        let (progress, shares) = heard();
        progress.expect(8.0);
        std::thread::scope(|scope| {
            for _ in 0..8 {
                scope.spawn(|| {
                    let part = progress.part(1.0);
                    part.expect(100.0);
                    (0..100).for_each(|_| part.advance(1.0));
                });
            }
        });
        let shares = shares.lock().unwrap();
        assert!(shares.windows(2).all(|pair| pair[0] < pair[1]) && (shares[shares.len() - 1] - 1.0).abs() < 1e-9);
    }

    #[test]
    fn whoever_asks_stops_all_parts() {
        let progress = Progress::none();
        let part = progress.part(1.0).part(1.0);
        assert!(part.check().is_ok());
        progress.clone().cancel();
        assert_eq!(part.check().unwrap_err().kind(), ErrorKind::Cancelled);
        let flag = Arc::new(AtomicBool::new(false));
        let progress = Progress::none().stopped_by(Arc::clone(&flag));
        assert!(progress.check().is_ok());
        flag.store(true, Ordering::Relaxed);
        assert!(progress.part(1.0).check().is_err());
    }
}
