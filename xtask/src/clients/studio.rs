//! The studio: its tests with a software adapter, and its window on a display without a screen.

use crate::failure::Result;
use crate::shell::{cargo, run as sh};

/// Tests it as a person uses it, and opens its window in both languages.
pub fn check() -> Result {
    sh(&mut cargo("clippy --quiet --package orogen-studio --all-targets --features kittest -- -D warnings"))?;
    sh(&mut cargo("test --package orogen-studio --features kittest"))?;
    sh(&mut cargo("build --quiet --package orogen-studio --features kittest"))?;
    super::script("studio")
}
