//! Tests on any adapter of this machine.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test that fails panics")]

mod common;
mod derived;
mod filters;
mod job;
mod learned;
mod level_layers;
mod levels;
mod noise;
mod programs;
mod realism;
mod render;
mod solvers;
