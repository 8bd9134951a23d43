//! Long work: without the interpreter's lock, with progress, and cancelled by Ctrl-C.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::thread;
use std::time::Duration;

use orogen::{Progress, Result};
use pyo3::prelude::*;

use crate::failure::{internal, raised};

/// How often signals are checked and progress is told.
const PERIOD: Duration = Duration::from_millis(50);

/// Does work on a thread of its own. Meanwhile this thread lets other Python threads run, checks for Ctrl-C, and calls
/// `progress` with the share that is done, 0 to 1. If a signal or `progress` raises an exception, the work is
/// cancelled, and the exception is raised after it has ended.
///
/// # Errors
/// Those of the work, as exceptions.
pub fn run<T: Send>(
    py: Python<'_>,
    listener: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&Progress) -> Result<T> + Send,
) -> PyResult<T> {
    let listener = listener.filter(|listener| !listener.is_none()).map(|listener| listener.clone().unbind());
    let share = Arc::new(AtomicU64::new(0));
    let progress = Progress::new({
        let share = Arc::clone(&share);
        move |done| share.store(done.to_bits(), Ordering::Relaxed)
    });
    let mut told = 0.0;
    let mut tell = |py: Python<'_>, share: f64| -> PyResult<()> {
        let Some(listener) = listener.as_ref().filter(|_| share > told) else { return Ok(()) };
        told = share;
        listener.call1(py, (share,)).map(drop)
    };
    let (ended, interruption) = py.detach(|| {
        thread::scope(|scope| {
            let (sender, receiver) = sync_channel::<()>(1);
            let worker = scope.spawn(|| {
                // Dropped when the work ends, also by a panic.
                let _sender = sender;
                work(&progress)
            });
            let mut interruption = None;
            while let Err(RecvTimeoutError::Timeout) = receiver.recv_timeout(PERIOD) {
                if interruption.is_some() {
                    continue;
                }
                let heard = Python::attach(|py| {
                    py.check_signals()?;
                    tell(py, f64::from_bits(share.load(Ordering::Relaxed)))
                });
                interruption = heard.inspect_err(|_| progress.cancel()).err();
            }
            (worker.join(), interruption)
        })
    });
    if let Some(exception) = interruption {
        return Err(exception);
    }
    let done = match ended {
        Ok(result) => result.map_err(|error| raised(py, &error))?,
        Err(panic) => {
            let message = panic.downcast_ref::<String>().map(String::as_str);
            let message = message.or(panic.downcast_ref::<&str>().copied()).unwrap_or("unknown");
            return Err(internal(py, &format!("a bug: the work panicked: {message}")));
        }
    };
    tell(py, 1.0)?;
    Ok(done)
}
