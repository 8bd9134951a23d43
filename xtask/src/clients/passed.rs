//! A committed file with the date when each step on request last passed, one line per step.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use crate::failure::Result;
use crate::{host, shell};

/// Days after which a step should be run again.
pub const MAX_AGE: i64 = 14;

/// The head of the file.
const HEAD: &str = "# When each step of `cargo xtask clients --all` on request last passed. The command writes this file.\n\
    # step, date, commit (+ if files had changed since), processor\n";

/// The last pass of a step: date, commit and processor, as in the file.
type Passes = BTreeMap<String, String>;

fn path() -> PathBuf {
    shell::root().join("xtask/clients/passed.txt")
}

/// Records that a step has passed now.
pub fn note(step: &str) -> Result {
    // Steps run in parallel.
    static WRITING: Mutex<()> = Mutex::new(());
    let pass = format!("{} {} {}", host::date(), commit()?, host::processor());
    let _writing = WRITING.lock().unwrap_or_else(PoisonError::into_inner);
    let mut passes = parse(&shell::read(&path())?);
    passes.insert(step.to_owned(), pass);
    shell::write(&path(), &text(&passes))
}

/// The commit, with a `+` if files other than the one written here have changed since.
fn commit() -> Result<String> {
    let commit = shell::capture(shell::program("git").args(["rev-parse", "--short", "HEAD"]))?;
    let changes = ["status", "--porcelain", "--", ".", ":!xtask/clients/passed.txt"];
    let is_clean = shell::capture(shell::program("git").args(changes))?.is_empty();
    Ok(format!("{}{}", commit.trim(), if is_clean { "" } else { "+" }))
}

/// The given steps that have not passed for too long, each with its last pass.
pub fn old(steps: &[&str]) -> Result<Vec<String>> {
    Ok(older(&parse(&shell::read(&path())?), steps, host::today()))
}

fn older(passes: &Passes, steps: &[&str], today: i64) -> Vec<String> {
    let line = |step: &&str| match passes.get(*step) {
        None => Some(format!("{step}: never")),
        Some(pass) => {
            let date = pass.split(' ').next().and_then(host::parse_date);
            let is_old = date.is_none_or(|date| today - date > MAX_AGE);
            is_old.then(|| format!("{step}: {pass}"))
        }
    };
    steps.iter().filter_map(line).collect()
}

fn parse(text: &str) -> Passes {
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    lines.filter_map(|line| line.split_once(' ')).map(|(step, pass)| (step.to_owned(), pass.to_owned())).collect()
}

fn text(passes: &Passes) -> String {
    let lines = passes.iter().map(|(step, pass)| format!("{step} {pass}\n"));
    HEAD.to_owned() + &lines.collect::<String>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_that_passed_long_ago_are_listed() {
        let passes = parse("# head\nfuzz 2026-01-10 0a1b2c3 some CPU\nneon 2026-01-20 0a1b2c3+ some CPU\nodd\n");
        assert_eq!(parse(&text(&passes)), passes);
        let today = host::parse_date("2026-01-25").expect("a date");
        assert_eq!(
            older(&passes, &["fuzz", "neon", "asan"], today),
            ["fuzz: 2026-01-10 0a1b2c3 some CPU", "asan: never"]
        );
        assert!(older(&passes, &["fuzz"], host::parse_date("2026-01-24").expect("a date")).is_empty());
    }

    #[test]
    fn the_file_is_as_it_is_written() {
        let file = shell::read(&path()).expect("the file");
        assert_eq!(text(&parse(&file)), file);
    }
}
