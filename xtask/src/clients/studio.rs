//! The studio: its tests with a software adapter, and its window on a display without a screen.

use crate::failure::Result;
use crate::shell::{cargo, run as sh};

/// Tests it as a person uses it, and opens its window in both languages.
pub fn check() -> Result {
    sh(&mut cargo("clippy --quiet --package orogen-studio --all-targets -- -D warnings"))?;
    sh(&mut cargo("test --package orogen-studio"))?;
    sh(&mut cargo("build --quiet --package orogen-studio"))?;
    super::script("studio")
}
