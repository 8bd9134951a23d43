//! Ctrl-C, and the request to end that a system sends.

use std::io::{self, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

use orogen::{Error, ErrorKind};

use crate::failure::{Failure, INTERRUPTED};

/// The flag that an interruption sets. The first one asks the work to stop, so that it puts away what it has begun; a second ends
/// the process at once.
pub fn flag() -> Arc<AtomicBool> {
    static FLAG: OnceLock<Arc<AtomicBool>> = OnceLock::new();
    let flag = FLAG.get_or_init(|| {
        let flag = Arc::new(AtomicBool::new(false));
        let handled = Arc::clone(&flag);
        // Where no handler can be set, Ctrl-C goes on to do what it always did.
        let _ = ctrlc::set_handler(move || {
            if handled.swap(true, Ordering::Relaxed) {
                std::process::exit(i32::from(INTERRUPTED));
            }
        });
        flag
    });
    Arc::clone(flag)
}

/// Whether it was asked for.
pub fn asked() -> bool {
    flag().load(Ordering::Relaxed)
}

/// A failure as what it is if an interruption was its cause: `then` says what that leaves behind.
pub fn explain(failure: Failure, then: &str) -> Failure {
    match failure {
        // Encoders make plain I/O errors of what a [`Stoppable`] tells them.
        Failure::Engine(error) if matches!(error.kind(), ErrorKind::Cancelled | ErrorKind::File) && asked() => {
            Failure::Interrupted(format!("stopped: {then}"))
        }
        other => other,
    }
}

/// A writer that fails once an interruption was asked for.
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
