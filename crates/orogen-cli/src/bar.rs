//! Progress of long work: a bar on a terminal, or lines for logs and other programs.

use std::io::{self, IsTerminal};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use clap::ValueEnum;
use indicatif::{ProgressBar, ProgressStyle};
use orogen::Progress;

use crate::{interrupt, say};

/// How progress is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum Mode {
    /// A bar if standard error is a terminal, otherwise one line if the work takes more than a minute
    #[default]
    Auto,
    /// A line on standard error every second: "12 %, 34 s left"
    Plain,
    /// A line of JSON on standard error ten times per second: share done (0 to 1), elapsed seconds, and remaining
    /// seconds or null
    Json,
    /// No progress
    None,
}

static MODE: OnceLock<Mode> = OnceLock::new();

/// Sets how this process shows progress.
pub fn set_mode(mode: Mode) {
    let _ = MODE.set(mode);
}

/// Work that ends sooner shows no bar.
const PATIENCE: Duration = Duration::from_millis(400);

/// Interval of updates.
const INTERVAL: Duration = Duration::from_millis(100);

/// Interval of lines for logs.
const LOGGED: Duration = Duration::from_secs(1);

/// Estimated duration above which work is announced if no bar is shown, and the time after which it is estimated.
const LONG: Duration = Duration::from_secs(60);
const TRIAL: Duration = Duration::from_secs(5);

/// Resolution of the bar.
const STEPS: u64 = 1000;

/// Shows the progress of one piece of work until dropped.
pub struct Bar {
    watch: Arc<Watch>,
    painter: Option<JoinHandle<()>>,
}

/// State shared by the work and the thread that shows its progress.
struct Watch {
    begun: Instant,
    /// Bits of the share that is done.
    share: AtomicU64,
    ended: AtomicBool,
}

impl Bar {
    /// Progress of one piece of work, shown by the bar unless `quiet`. Ctrl-C cancels the work.
    pub fn new(quiet: bool) -> (Bar, Progress) {
        let watch = Arc::new(Watch { begun: Instant::now(), share: AtomicU64::new(0), ended: AtomicBool::new(false) });
        let mode = match MODE.get().copied().unwrap_or_default() {
            _ if quiet => Mode::None,
            mode => mode,
        };
        if mode == Mode::None {
            return (Bar { watch, painter: None }, Progress::none().stopped_by(interrupt::flag()));
        }
        let heard = Arc::clone(&watch);
        let progress = Progress::new(move |share| heard.share.store(share.to_bits(), Ordering::Relaxed));
        let seen = Arc::clone(&watch);
        // A separate thread, so that the remaining time is updated even if the work reports nothing.
        let painter = std::thread::spawn(move || match mode {
            Mode::Plain => seen.print(LOGGED, |at| match at.left() {
                Some(left) => format!("{:.0} %, {} left", at.percent(), duration(left)),
                None => format!("{:.0} %", at.percent()),
            }),
            Mode::Json => seen.print(INTERVAL, |at| {
                let left = at.left().map_or("null".to_string(), |left| format!("{left:.1}"));
                format!(r#"{{"share":{:.5},"seconds":{:.2},"left":{left}}}"#, at.share, at.elapsed)
            }),
            Mode::Auto if !io::stderr().is_terminal() => seen.announce(),
            Mode::Auto | Mode::None => seen.paint(),
        });
        (Bar { watch, painter: Some(painter) }, progress.stopped_by(interrupt::flag()))
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.watch.ended.store(true, Ordering::Relaxed);
        if let Some(painter) = self.painter.take() {
            painter.thread().unpark();
            let _ = painter.join();
        }
    }
}

/// The state of work at one moment.
#[derive(Debug, Clone, Copy)]
struct Moment {
    share: f64,
    /// Seconds since the start.
    elapsed: f64,
}

impl Moment {
    /// Whole per cent; 100 only when everything is done.
    fn percent(&self) -> f64 {
        (100.0 * self.share + 1e-9).floor()
    }

    /// Estimated seconds left; `None` while too little is done for an estimate.
    fn left(&self) -> Option<f64> {
        let tells = self.share > 0.005 && self.elapsed > 0.5 || self.share > 0.0 && self.elapsed > 10.0;
        tells.then(|| self.elapsed * (1.0 - self.share) / self.share)
    }
}

impl Watch {
    fn moment(&self) -> Moment {
        Moment {
            share: f64::from_bits(self.share.load(Ordering::Relaxed)),
            elapsed: self.begun.elapsed().as_secs_f64(),
        }
    }

    fn has_ended(&self) -> bool {
        self.ended.load(Ordering::Relaxed)
    }

    /// Prints a line every `interval` until the end.
    fn print(&self, interval: Duration, line: impl Fn(&Moment) -> String) {
        let mut printed = Instant::now();
        while !self.has_ended() {
            std::thread::park_timeout(INTERVAL.min(interval));
            if printed.elapsed() >= interval {
                printed = Instant::now();
                say::error(&line(&self.moment()));
            }
        }
        // The last line says how the work ended.
        say::error(&line(&self.moment()));
    }

    /// Prints one line if the work takes long.
    fn announce(&self) {
        while !self.has_ended() {
            std::thread::park_timeout(LOGGED);
            let at = self.moment();
            let told = at.elapsed >= TRIAL.as_secs_f64() && !self.has_ended();
            if let Some(left) = at.left().filter(|_| told) {
                if left + at.elapsed > LONG.as_secs_f64() {
                    say::error(&format!(
                        "note: about {} left; --progress plain reports it each second",
                        duration(left)
                    ));
                }
                return;
            }
        }
    }

    /// Shows a bar until the end.
    fn paint(&self) {
        while !self.has_ended() && self.begun.elapsed() < PATIENCE {
            std::thread::park_timeout(PATIENCE.saturating_sub(self.begun.elapsed()));
        }
        if self.has_ended() {
            return;
        }
        let bar = ProgressBar::new(STEPS);
        if let Ok(style) = ProgressStyle::with_template("{bar:40} {msg}") {
            bar.set_style(style);
        }
        while !self.has_ended() {
            let at = self.moment();
            bar.set_position((at.share * STEPS as f64) as u64);
            let left = at.left().map_or(String::new(), |left| format!("  {} left", duration(left)));
            bar.set_message(format!("{:>3} %{left}", at.percent()));
            std::thread::park_timeout(INTERVAL);
        }
        bar.finish_and_clear();
    }
}

/// Seconds, formatted for users.
fn duration(seconds: f64) -> String {
    let seconds = seconds.round().clamp(0.0, 1e9) as u64;
    match seconds {
        0..60 => format!("{seconds} s"),
        60..3600 => format!("{} min {} s", seconds / 60, seconds % 60),
        _ => format!("{} h {} min", seconds / 3600, seconds / 60 % 60),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_left_follows_from_the_share() {
        let at = |share, elapsed| Moment { share, elapsed };
        assert_eq!(at(0.25, 10.0).left(), Some(30.0));
        assert_eq!(at(0.001, 10.0).left(), None, "too early to tell");
        assert_eq!([at(0.999, 1.0).percent(), at(1.0, 1.0).percent()], [99.0, 100.0]);
        assert_eq!([4.4, 75.0, 7260.0].map(duration), ["4 s", "1 min 15 s", "2 h 1 min"]);
    }
}
