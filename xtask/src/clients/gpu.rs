//! Graphics cards: the tests of their shaders, and the command line with and without a card. Where there is none, Mesa's software Vulkan stands in.

use crate::failure::Result;
use crate::shell::{cargo, run as sh};

/// What is built together, so that the libraries of drivers are built once for the studio and for this.
pub const PACKAGES: &str = "--package orogen-gpu --package orogen-studio --package orogen-cli \
    --features orogen-studio/kittest,orogen-cli/gpu";

/// Compares fields, filters, solvers, presets and pictures with those of the processor, and runs commands without any card.
pub fn check() -> Result {
    lint()?;
    sh(&mut cargo(&format!("test {PACKAGES} --test suite")))?;
    sh(&mut cargo(&format!("build --quiet {PACKAGES} --bins")))?;
    super::script("gpu")
}

/// Clippy of what is built together.
pub fn lint() -> Result {
    sh(&mut cargo(&format!("clippy --quiet {PACKAGES} --all-targets -- -D warnings")))
}
