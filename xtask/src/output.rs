//! Output of steps. It goes to the log of the step, which is printed as it grows while the step runs alone.

use std::cell::RefCell;
use std::fmt::Display;
use std::fs::File;
use std::io::{self, Write as _};
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// Interval at which a followed log is read.
const POLLED: Duration = Duration::from_millis(100);

thread_local! {
    static LOG: RefCell<Option<Arc<File>>> = const { RefCell::new(None) };
}

/// The log of this thread; `None` if its output goes to ours.
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

/// Sends the output of a program to the output of this thread.
pub fn connect(command: &mut Command) -> &mut Command {
    match (copy(), copy()) {
        (Some(out), Some(errors)) => command.stdout(out).stderr(errors),
        _ => command,
    }
}

/// Sends only the errors of a program, whose output is read, to the output of this thread.
pub fn connect_errors(command: &mut Command) -> &mut Command {
    command.stderr(copy().unwrap_or_else(Stdio::inherit))
}

/// Prints text that is appended to a log, until `is_complete` is set and everything is printed.
pub fn follow(log: &Path, is_complete: &AtomicBool) {
    let Ok(mut file) = File::open(log) else { return };
    loop {
        // Loaded before the rest is read, so that everything that was appended until then is printed.
        let is_last = is_complete.load(Ordering::Acquire);
        // Text that cannot be printed is still in the log.
        drop(io::copy(&mut file, &mut io::stdout().lock()));
        drop(io::stdout().flush());
        if is_last {
            return;
        }
        std::thread::sleep(POLLED);
    }
}

/// The last lines of a text.
pub fn tail(text: &str, lines: usize) -> String {
    let all: Vec<&str> = text.lines().collect();
    all[all.len().saturating_sub(lines)..].join("\n")
}

/// Another handle of the log.
fn copy() -> Option<Stdio> {
    log().and_then(|log| log.try_clone().ok()).map(Stdio::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tail_is_the_last_lines() {
        assert_eq!(tail("a\nb\nc\n", 2), "b\nc");
        assert_eq!(tail("a\n", 2), "a");
        assert_eq!(tail("", 2), "");
    }
}
