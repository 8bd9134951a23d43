//! Where the output of a step goes: to ours, or to a log while other steps run beside it.

use std::cell::RefCell;
use std::fmt::Display;
use std::fs::File;
use std::io::Write as _;
use std::process::{Command, Stdio};
use std::sync::Arc;

thread_local! {
    static LOG: RefCell<Option<Arc<File>>> = const { RefCell::new(None) };
}

/// The log of this thread, or `None` if its output is ours.
pub fn log() -> Option<Arc<File>> {
    LOG.with_borrow(Clone::clone)
}

/// Sends the lines of this thread, and the output of programs that it starts from here on, to a log.
pub fn set_log(log: Option<Arc<File>>) {
    LOG.set(log);
}

/// Prints a line of a step.
pub fn line(text: impl Display) {
    match log() {
        // A line that cannot be written is missing; the step's result does not depend on it.
        Some(log) => drop(writeln!(&*log, "{text}")),
        None => println!("{text}"),
    }
}

/// Sends what a program prints where this thread's output goes.
pub fn connect(command: &mut Command) -> &mut Command {
    match (copy(), copy()) {
        (Some(out), Some(errors)) => command.stdout(out).stderr(errors),
        _ => command,
    }
}

/// The same for a program whose output is read: its errors alone.
pub fn connect_errors(command: &mut Command) -> &mut Command {
    command.stderr(copy().unwrap_or_else(Stdio::inherit))
}

/// Another handle of the log.
fn copy() -> Option<Stdio> {
    log().and_then(|log| log.try_clone().ok()).map(Stdio::from)
}
