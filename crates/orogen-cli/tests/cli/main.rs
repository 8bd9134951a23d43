//! The `orogen` command as its users meet it: the built program, run in folders of its own.
// Clippy knows test functions, but not that all of this file is for them.
#![allow(clippy::unwrap_used, clippy::panic)]

mod bad_places;
mod bad_recipes;
mod build;
mod cache;
mod check;
mod commands;
mod compare;
mod export;
mod generate;
mod harness;
mod leftovers;
#[cfg(unix)]
mod limits;
mod map;
mod memory;
mod noise;
mod not_finite;
mod others;
mod outputs;
mod palettes;
mod parameters;
mod places;
mod progress;
mod render;
mod surfaces;
mod view;
mod watch;
mod water;
