//! Ctrl-C and termination signals.

use std::io::{self, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

use orogen::{Error, ErrorKind};

use crate::failure::{Failure, INTERRUPTED};

/// The flag that an interruption sets. The first one cancels the work, which cleans up; a second one ends the process
/// at once.
pub fn flag() -> Arc<AtomicBool> {
    Arc::clone(shared())
}

fn shared() -> &'static Arc<AtomicBool> {
    static FLAG: OnceLock<Arc<AtomicBool>> = OnceLock::new();
    FLAG.get_or_init(|| {
        let flag = Arc::new(AtomicBool::new(false));
        let handled = Arc::clone(&flag);
        // If no handler can be set, Ctrl-C keeps its default effect.
        let _ = ctrlc::set_handler(move || {
            if handled.swap(true, Ordering::Relaxed) {
                std::process::exit(i32::from(INTERRUPTED));
            }
        });
        flag
    })
}

/// Whether an interruption was requested.
pub fn asked() -> bool {
    shared().load(Ordering::Relaxed)
}

/// Converts a failure caused by an interruption; `then` describes the state that it leaves behind.
pub fn explain(failure: Failure, then: &str) -> Failure {
    match failure {
        // Encoders convert the error of a [`Stoppable`] to a plain I/O error.
        Failure::Engine(error) if matches!(error.kind(), ErrorKind::Cancelled | ErrorKind::File) && asked() => {
            Failure::Interrupted(format!("stopped: {then}"))
        }
        other => other,
    }
}

/// A writer that fails after an interruption.
pub struct Stoppable<'a>(pub &'a mut dyn Write);

impl Write for Stoppable<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match asked() {
            true => Err(io::Error::from(Error::new(ErrorKind::Cancelled, "the work was cancelled"))),
            false => self.0.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}
