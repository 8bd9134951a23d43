//! `cargo xtask bless`: rewrites golden files, after showing the differences.

use std::io::{BufRead, IsTerminal, Write};
use std::path::Path;

use crate::failure::{Failure, Result, on_file};
use crate::shell;

pub const ABOUT: &str = "rewrite the golden files, show the differences and ask whether to keep them";

pub const HELP: &str = "
Usage: cargo xtask bless [--yes] [TEST]

Runs the tests with OROGEN_BLESS=1, which makes them write golden files instead of comparing with them, shows the differences
of golden/ and asks whether to keep them. Otherwise it restores the old files.

  --yes  keep the files without asking
  TEST   only tests whose name contains TEST

A changed golden file is changed terrain: add a line to CHANGELOG.md that says which terrain changed and why.
";

/// Maximum number of printed lines of a difference.
const SHOWN_LINES: usize = 200;

/// Blesses the golden files.
pub fn run(args: &[String]) -> Result {
    let yes = args.iter().any(|a| a == "--yes");
    let named: Vec<&String> = args.iter().filter(|a| *a != "--yes").collect();
    if named.len() > 1 || named.iter().any(|n| n.starts_with('-')) {
        return Err(Failure::usage("expected [--yes] [TEST]"));
    }
    let golden = shell::root().join("golden");
    let before = shell::target_dir().join("bless/before");
    shell::empty_dir(&before)?;
    std::fs::create_dir_all(&golden).map_err(|e| on_file("create", &golden, &e))?;
    copy(&golden, &before)?;

    let mut tests = shell::cargo("test --quiet --workspace");
    tests.args(named).env("OROGEN_BLESS", "1");
    let tested = shell::run(&mut tests);
    if tested.is_err() {
        // The output of a failed run is discarded; the tests print the problems.
        replace(&golden, &before)?;
        return tested;
    }
    let changes = difference(&before, &golden)?;
    if changes.is_empty() {
        println!("golden/ is as it was");
        return Ok(());
    }
    print!("{changes}");
    if yes || confirmed()? {
        println!("kept");
        return Ok(());
    }
    replace(&golden, &before)?;
    Err(Failure::new("not kept: golden/ is as it was"))
}

/// The output of `git diff` for the two folders, with its summary first, truncated if it is long.
fn difference(before: &Path, after: &Path) -> Result<String> {
    let mut text = String::new();
    for form in ["--stat", "--patch"] {
        let output = shell::program("git")
            .args(["diff", "--no-index", "--no-color", form, "--"])
            .args([before, after])
            .output()
            .map_err(|e| Failure::new(format!("cannot start git: {e}")))?;
        let shown = String::from_utf8_lossy(&output.stdout).into_owned();
        let lines = shown.lines().count();
        text.extend(shown.lines().take(SHOWN_LINES).map(|l| format!("{l}\n")));
        if lines > SHOWN_LINES {
            text.push_str(&format!("... and {} more lines\n", lines - SHOWN_LINES));
        }
    }
    Ok(text)
}

fn confirmed() -> Result<bool> {
    if !std::io::stdin().is_terminal() {
        println!("nobody to ask: say --yes to keep it");
        return Ok(false);
    }
    print!("keep this? [y/N] ");
    let mut answer = String::new();
    std::io::stdout()
        .flush()
        .and_then(|()| std::io::stdin().lock().read_line(&mut answer))
        .map_err(|e| Failure::new(format!("cannot ask: {e}")))?;
    Ok(matches!(answer.trim(), "y" | "Y" | "yes"))
}

fn replace(folder: &Path, with: &Path) -> Result {
    shell::empty_dir(folder)?;
    copy(with, folder)
}

/// Copies the content of a folder into another.
fn copy(from: &Path, to: &Path) -> Result {
    for entry in std::fs::read_dir(from).map_err(|e| on_file("read", from, &e))? {
        let path = entry.map_err(|e| on_file("read", from, &e))?.path();
        let target = to.join(path.file_name().unwrap_or_default());
        if path.is_dir() {
            std::fs::create_dir_all(&target).map_err(|e| on_file("create", &target, &e))?;
            copy(&path, &target)?;
        } else {
            std::fs::copy(&path, &target).map_err(|e| on_file("copy to", &target, &e))?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_is_put_back_whole() {
        let base = std::env::temp_dir().join(format!("orogen-bless-{}", std::process::id()));
        let (golden, before) = (base.join("golden"), base.join("before"));
        std::fs::create_dir_all(golden.join("deep")).expect("a temporary folder");
        std::fs::create_dir_all(&before).expect("a temporary folder");
        std::fs::write(golden.join("deep/a.txt"), "old").expect("a file");
        copy(&golden, &before).expect("copied");
        assert_eq!(difference(&before, &golden).expect("git runs"), "");

        std::fs::write(golden.join("deep/a.txt"), "new").expect("a file");
        std::fs::write(golden.join("added.txt"), "new").expect("a file");
        let shown = difference(&before, &golden).expect("git runs");
        assert!(shown.contains("-old\n") && shown.contains("+new\n") && shown.contains("2 files changed"), "{shown}");

        replace(&golden, &before).expect("put back");
        assert_eq!(std::fs::read_to_string(golden.join("deep/a.txt")).expect("a file"), "old");
        assert!(!golden.join("added.txt").exists());
        std::fs::remove_dir_all(&base).expect("removed");
    }
}
