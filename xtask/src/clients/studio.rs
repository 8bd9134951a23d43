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

/// Runs its tests of user actions, and opens its window in both languages.
pub fn check() -> Result {
    sh(&mut cargo(&format!("test --quiet {WINDOW} --lib --test window")))?;
    sh(&mut cargo(&format!("build --quiet {WINDOW} --bins")))?;
    super::script("studio")
}
