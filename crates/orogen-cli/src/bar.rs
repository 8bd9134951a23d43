//! A progress bar for long work, on a terminal.

use std::fmt::Write;
use std::io::{self, IsTerminal};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressState, ProgressStyle};
use orogen::Progress;

use crate::interrupt;

/// Work that is done sooner needs no bar.
const PATIENCE: Duration = Duration::from_millis(400);

/// Shows the progress of one piece of work until dropped.
pub struct Bar {
    shown: Arc<Mutex<Option<ProgressBar>>>,
}

impl Bar {
    /// A bar, and the progress that moves it: on standard error if that is a terminal and `quiet` is not asked for, else
    /// nowhere. Ctrl-C stops the work.
    pub fn new(quiet: bool) -> (Bar, Progress) {
        let shown = Arc::new(Mutex::new(None));
        let bar = Bar { shown: Arc::clone(&shown) };
        if quiet || !io::stderr().is_terminal() {
            return (bar, Progress::none().stopped_by(interrupt::flag()));
        }
        let begun = Instant::now();
        let progress = Progress::new(move |done, total| {
            // A bar that another thread is just moving needs no second push.
            if begun.elapsed() > PATIENCE
                && let Ok(mut shown) = shown.try_lock()
            {
                let bar = shown.get_or_insert_with(ready);
                bar.set_length(total);
                bar.set_position(done);
            }
        });
        (bar, progress.stopped_by(interrupt::flag()))
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        if let Ok(mut shown) = self.shown.lock()
            && let Some(bar) = shown.take()
        {
            bar.finish_and_clear();
        }
    }
}

fn ready() -> ProgressBar {
    let bar = ProgressBar::new(0);
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {percent:>3} %  {rate}, {eta} left") {
        bar.set_style(style.with_key("rate", rate));
    }
    bar
}

/// The unit of progress is samples.
fn rate(state: &ProgressState, out: &mut dyn Write) {
    let _ = write!(out, "{:.1} Msamples/s", state.per_sec() / 1e6);
}
