//! Ctrl-C and termination signals.

use std::io::{self, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

use orogen::{Error, ErrorKind};

use crate::failure::Failure;

/// The flag that an interruption sets. The first interruption cancels the work, which cleans up; a second one ends the
/// process at once.
pub fn flag() -> Arc<AtomicBool> {
    Arc::clone(&shared().asked)
}

/// The failure of an interrupted command. Its exit code is 128 plus the number of the signal, as in shells.
pub fn stopped(message: &str) -> Failure {
    Failure::Interrupted { message: message.to_string(), code: shared().signal.code() }
}

/// Whether an interruption was requested.
pub fn asked() -> bool {
    shared().asked.load(Ordering::Relaxed)
}

/// The state that the signals of this process set.
struct Interruption {
    asked: Arc<AtomicBool>,
    signal: Signal,
}

fn shared() -> &'static Interruption {
    static SHARED: OnceLock<Interruption> = OnceLock::new();
    SHARED.get_or_init(|| {
        let asked = Arc::new(AtomicBool::new(false));
        Interruption { signal: Signal::handled(&asked), asked }
    })
}

#[cfg(unix)]
use unix::Signal;

#[cfg(unix)]
mod unix {
    use std::sync::Arc;
    use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::flag;

    /// The number of the last signal.
    pub struct Signal(Arc<AtomicUsize>);

    impl Signal {
        /// Lets signals set `asked`, and end the process if it is already set. A signal without a handler keeps its
        /// default effect.
        pub fn handled(asked: &Arc<AtomicBool>) -> Signal {
            let last = Arc::new(AtomicUsize::new(SIGINT as usize));
            for signal in [SIGINT, SIGTERM, SIGHUP] {
                // The order matters: the condition must be false for the first signal.
                let _ = flag::register_conditional_shutdown(signal, 128 + signal, Arc::clone(asked))
                    .and_then(|_| flag::register_usize(signal, Arc::clone(&last), signal as usize))
                    .and_then(|_| flag::register(signal, Arc::clone(asked)));
            }
            Signal(last)
        }

        pub fn code(&self) -> u8 {
            128 + self.0.load(Ordering::Relaxed) as u8
        }
    }
}

/// Systems without signals: the code of Ctrl-C.
#[cfg(not(unix))]
struct Signal;

#[cfg(not(unix))]
impl Signal {
    fn handled(asked: &Arc<AtomicBool>) -> Signal {
        let handled = Arc::clone(asked);
        // If no handler can be set, Ctrl-C keeps its default effect.
        let _ = ctrlc::set_handler(move || {
            if handled.swap(true, Ordering::Relaxed) {
                std::process::exit(i32::from(Signal.code()));
            }
        });
        Signal
    }

    fn code(&self) -> u8 {
        130
    }
}

/// Converts a failure caused by an interruption; `then` describes the state that it leaves behind.
pub fn explain(failure: Failure, then: &str) -> Failure {
    match failure {
        // Encoders convert the error of a [`Stoppable`] to a plain I/O error.
        Failure::Engine(error) if matches!(error.kind(), ErrorKind::Cancelled | ErrorKind::File) && asked() => {
            stopped(&format!("stopped: {then}"))
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
