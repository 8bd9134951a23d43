//! The studio: its tests with a software adapter, and its window on a display without a screen.

use crate::compiled::WINDOW;
use crate::failure::Result;
use crate::package;
use crate::shell::{cargo, run as sh};

/// Compiles the packages that need the libraries of windows and graphics cards, with their tests.
pub fn build() -> Result {
    sh(&mut cargo(&format!("clippy --quiet {WINDOW} --all-targets -- -D warnings")))?;
    package::check_window()?;
    sh(&mut cargo(&format!("test --quiet {WINDOW} --no-run")))?;
    sh(&mut cargo(&format!("build --quiet {WINDOW} --bins")))
}

/// The folder in which the script of the jobs leaves its pictures.
pub fn pictures() -> std::path::PathBuf {
    super::folder().join("work/studio-jobs")
}

/// Runs its tests of user actions, opens its window in both languages, and does the jobs of a new user there.
pub fn check() -> Result {
    sh(&mut cargo(&format!("test --quiet {WINDOW} --lib --test window")))?;
    sh(&mut cargo(&format!("build --quiet {WINDOW} --bins")))?;
    super::script("studio")?;
    super::script_for("studio", "jobs")
}
