//! The studio: its tests with a software adapter, and its window on a display without a screen.

use super::gpu::{PACKAGES, lint};
use crate::failure::Result;
use crate::shell::{cargo, run as sh};

/// Tests it as a person uses it, and opens its window in both languages.
pub fn check() -> Result {
    lint()?;
    sh(&mut cargo(&format!("test {PACKAGES} --lib --test window")))?;
    sh(&mut cargo(&format!("build --quiet {PACKAGES} --bins")))?;
    super::script("studio")
}
