//! Named steps in order, each timed; the first failure ends the run. Neighbors of the same group run in parallel. The
//! output of a step is kept in `steps/NAME.log` in the target folder.

use std::fs::File;
use std::io::{self, Write as _};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use crate::failure::{Failure, Result, on_file};
use crate::{output, pool, shell, table};

/// A step.
pub struct Step {
    /// The name on the command line.
    pub name: &'static str,
    /// The description in the list.
    pub about: &'static str,
    /// Neighbors of the same group run in parallel: none depends on another one, shares a folder with it or has time
    /// limits. A step without a group runs alone.
    pub group: Option<u32>,
    /// The function. It prints with [`output::line`] and starts programs with [`shell`].
    pub run: fn() -> Result,
}

/// Lines of a failed step's log that are printed again at the end.
const LAST_LINES: usize = 60;

/// A run of steps.
struct Run<'a> {
    /// The command that runs a single step.
    command: &'a str,
    /// The names and times in seconds of finished steps.
    done: Mutex<Vec<Vec<String>>>,
    /// The names of failed steps.
    failed: Mutex<Vec<&'static str>>,
}

/// Runs the named steps, or all of them, and prints the time of each. `command` is the command that runs a single step.
/// If a step fails, the end of its log is printed last.
pub fn run(command: &str, steps: &[&Step], named: &[String]) -> Result {
    let chosen = choose(steps, named)?;
    let begun = Instant::now();
    let run = Run { command, done: Mutex::default(), failed: Mutex::default() };
    for group in chosen.chunk_by(|a, b| a.group.is_some() && a.group == b.group) {
        let result = match group {
            [step] => run.in_sight(step),
            several => pool::run(several.to_vec(), |step| run.logged(step)),
        };
        if result.is_err() {
            run.print_failed();
        }
        result?;
    }
    let done = run.done.into_inner().unwrap_or_else(PoisonError::into_inner);
    println!("\n{}", table::render(&["step", "seconds"], &done));
    println!("all {} steps well in {:.1} s", done.len(), begun.elapsed().as_secs_f64());
    Ok(())
}

impl Run<'_> {
    /// Runs a step, and prints its output as it is written.
    fn in_sight(&self, step: &Step) -> Result {
        println!("{}", title(step));
        let (path, is_complete) = (new_log(step)?, AtomicBool::new(false));
        let seconds = std::thread::scope(|scope| {
            scope.spawn(|| output::follow(&path, &is_complete));
            // Also if the step panics: the scope waits for the thread that follows its log.
            let _end = Complete(&is_complete);
            self.timed(step)
        })?;
        println!("{}", self.end(step, seconds));
        Ok(())
    }

    /// Runs a step in parallel with others. Its output is printed when it ends.
    fn logged(&self, step: &Step) -> Result {
        let path = new_log(step)?;
        println!("    {} started", step.name);
        let result = self.timed(step);
        let mut text = format!("{}\n", title(step)).into_bytes();
        text.extend(std::fs::read(&path).map_err(|cause| on_file("read", &path, &cause))?);
        if let Ok(seconds) = &result {
            text.extend(format!("{}\n", self.end(step, seconds.clone())).into_bytes());
        }
        // Written at once, so that the output of other steps does not get between.
        io::stdout().lock().write_all(&text).map_err(|cause| Failure::new(format!("cannot print: {cause}")))?;
        result.map(drop)
    }

    /// Prints the ends of the logs of the steps that failed.
    fn print_failed(&self) {
        for name in self.failed.lock().unwrap_or_else(PoisonError::into_inner).iter() {
            // A log that cannot be read was printed before.
            if let Ok(text) = std::fs::read(log_path(name)) {
                let text = output::tail(&String::from_utf8_lossy(&text), LAST_LINES);
                println!("\n==> {name} failed; its last {LAST_LINES} lines:\n{text}\n");
            }
        }
    }

    /// Runs a step; returns its seconds.
    fn timed(&self, step: &Step) -> Result<String> {
        let start = Instant::now();
        let result = (step.run)();
        output::set_log(None);
        let seconds = format!("{:.1}", start.elapsed().as_secs_f64());
        match result {
            Ok(()) => Ok(seconds),
            Err(failure) => {
                self.failed.lock().unwrap_or_else(PoisonError::into_inner).push(step.name);
                Err(Failure::new(format!(
                    "step '{}' failed after {seconds} s: {}\n       run it alone: {} {}",
                    step.name,
                    failure.message(),
                    self.command,
                    step.name
                )))
            }
        }
    }

    /// Counts a step as done; returns the line to print.
    fn end(&self, step: &Step, seconds: String) -> String {
        let line = format!("    {} done in {seconds} s", step.name);
        self.done.lock().unwrap_or_else(PoisonError::into_inner).push(vec![step.name.to_owned(), seconds]);
        line
    }
}

/// Sets its value when it is dropped.
struct Complete<'a>(&'a AtomicBool);

impl Drop for Complete<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Release);
    }
}

/// Opens an empty log for a step that this thread runs; returns its path.
fn new_log(step: &Step) -> Result<PathBuf> {
    let path = log_path(step.name);
    let folder = path.parent().unwrap_or(&path);
    std::fs::create_dir_all(folder).map_err(|cause| on_file("create", folder, &cause))?;
    // Emptied, then appended to: several programs write to it.
    let log = File::create(&path).and_then(|_| File::options().append(true).open(&path));
    output::set_log(Some(Arc::new(log.map_err(|cause| on_file("create", &path, &cause))?)));
    Ok(path)
}

fn log_path(step: &str) -> PathBuf {
    shell::target_dir().join("steps").join(format!("{step}.log"))
}

fn title(step: &Step) -> String {
    format!("==> {}: {}", step.name, step.about)
}

/// The named steps, or all of them.
pub fn choose<'a>(steps: &[&'a Step], named: &[String]) -> Result<Vec<&'a Step>> {
    if let Some(unknown) = named.iter().find(|n| steps.iter().all(|s| s.name != n.as_str())) {
        let rows: Vec<Vec<String>> = steps.iter().map(|s| vec![format!("  {}", s.name), s.about.to_owned()]).collect();
        return Err(Failure::usage(format!("there is no step '{unknown}'; there are\n{}", table::render(&[], &rows))));
    }
    Ok(steps.iter().copied().filter(|s| named.is_empty() || named.iter().any(|n| n == s.name)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fine() -> Result {
        Ok(())
    }

    fn broken() -> Result {
        (1..=100).for_each(|number| output::line(format_args!("line {number}")));
        Err(Failure::new("it broke"))
    }

    const FINE: Step = Step { name: "fine", about: "goes well", group: None, run: fine };
    const BROKEN: Step = Step { name: "broken", about: "does not", group: None, run: broken };

    #[test]
    fn a_failure_names_the_step_and_how_to_run_it() {
        let failure = run("cargo xtask test", &[&FINE, &BROKEN], &[]).expect_err("the second step fails");
        assert!(failure.message().contains("step 'broken' failed"), "{}", failure.message());
        assert!(failure.message().ends_with("run it alone: cargo xtask test broken"), "{}", failure.message());
        let log = shell::read(&log_path("broken")).expect("the log is kept");
        assert!(output::tail(&log, LAST_LINES).starts_with("line 41\nline 42\n"), "{log}");
        assert!(output::log().is_none());
    }

    #[test]
    fn steps_are_chosen_by_name() {
        run("x", &[&FINE, &BROKEN], &["fine".to_owned()]).expect("the broken step is not chosen");
        let failure = run("x", &[&FINE], &["fin".to_owned()]).expect_err("no such step");
        assert!(failure.message().contains("no step 'fin'"), "{}", failure.message());
    }

    #[test]
    fn steps_side_by_side_meet_and_their_failures_name_them() {
        // Each of the two waits for the other.
        static MEETING: std::sync::Barrier = std::sync::Barrier::new(2);
        fn meets() -> Result {
            MEETING.wait();
            Ok(())
        }
        fn meets_and_breaks() -> Result {
            output::line("a line of the log");
            MEETING.wait();
            Err(Failure::new("it broke"))
        }
        let one = Step { name: "one", about: "", group: Some(1), run: meets };
        let other = Step { name: "other", about: "", group: Some(1), run: meets_and_breaks };
        let failure = run("cargo xtask test", &[&one, &other, &BROKEN], &[]).expect_err("one of the two fails");
        assert!(failure.message().contains("step 'other' failed"), "{}", failure.message());
        assert!(failure.message().ends_with("run it alone: cargo xtask test other"), "{}", failure.message());
        let log = shell::read(&log_path("other")).expect("the log is kept");
        assert_eq!(log, "a line of the log\n");
        assert!(output::log().is_none());
    }
}
