//! Graphics cards: the tests of their shaders, and the command line with and without a card. Without a card, Mesa's
//! software Vulkan driver is used.

use crate::compiled::WINDOW;
use crate::failure::Result;
use crate::shell::{cargo, run as sh};

/// Compares fields, filters, solvers, presets and pictures with the processor's, and runs commands without any card.
pub fn check() -> Result {
    sh(&mut cargo(&format!("test --quiet {WINDOW} --test suite")))?;
    sh(&mut cargo(&format!("build --quiet {WINDOW} --bins")))?;
    super::script("gpu")
}
