//! Telling how far work has come, and asking it to stop.

use crate::error::{Error, ErrorKind, Result};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Shared between the caller and the work: counts up, and carries the wish to stop.
#[derive(Default)]
pub struct Progress {
    done: AtomicU64,
    total: AtomicU64,
    cancelled: Arc<AtomicBool>,
    /// Another's wish to stop.
    stop: Option<Arc<AtomicBool>>,
    tell: Option<Box<dyn Fn(u64, u64) + Send + Sync>>,
}

impl Progress {
    /// Tells nobody.
    pub fn none() -> Progress {
        Progress::default()
    }

    /// Calls `tell(done, total)` whenever some work is done, from any thread. The unit is samples.
    pub fn new(tell: impl Fn(u64, u64) + Send + Sync + 'static) -> Progress {
        Progress { tell: Some(Box::new(tell)), ..Progress::default() }
    }

    /// The same, stopped also by whoever sets `flag`: a signal's handler, which has no way to call [`Progress::cancel`].
    pub fn stopped_by(self, flag: Arc<AtomicBool>) -> Progress {
        Progress { stop: Some(flag), ..self }
    }

    /// Progress of a part of the work, which is stopped with the whole of it and tells nobody how far it has come.
    pub(crate) fn part(&self) -> Progress {
        Progress { cancelled: Arc::clone(&self.cancelled), stop: self.stop.clone(), ..Progress::none() }
    }

    /// Asks the work to stop soon; it ends with [`ErrorKind::Cancelled`].
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    /// Ok while the work is still wanted.
    pub fn check(&self) -> Result<()> {
        let asked = [Some(&self.cancelled), self.stop.as_ref()];
        match asked.into_iter().flatten().any(|flag| flag.load(Ordering::Relaxed)) {
            true => Err(Error::new(ErrorKind::Cancelled, "the work was cancelled")),
            false => Ok(()),
        }
    }

    /// More work has become known, or less of it.
    pub(crate) fn expect(&self, samples: i64) {
        let _ = self.total.fetch_add(samples as u64, Ordering::Relaxed);
    }

    /// Some work is done.
    pub(crate) fn advance(&self, samples: u64) {
        let done = self.done.fetch_add(samples, Ordering::Relaxed) + samples;
        if let Some(tell) = &self.tell {
            tell(done, self.total.load(Ordering::Relaxed));
        }
    }
}
