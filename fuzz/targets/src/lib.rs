//! Readers of files and texts, run on any bytes: each target panics if a reader breaks its promise.
//!
//! `cargo xtask fuzz` runs them with libFuzzer, and the tests run them on the files of `fuzz/corpus` and on changes of
//! those.
#![forbid(unsafe_code)]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a target that fails panics")]

pub mod author_map;
pub mod dem;
pub mod drawing;
mod edits;
pub mod journal;
pub mod network;
pub mod options;
pub mod palette;
pub mod place;
pub mod plan;
pub mod points;
pub mod recipe;
mod scratch;
pub mod sidecar;
pub mod solution;
pub mod tileset;
pub mod zarr;

// The parsers of the program `orogen` are no part of what its library offers, so they are compiled into the target
// `options`.
#[allow(dead_code, reason = "the target uses a part")]
#[path = "../../../crates/orogen-cli/src/failure.rs"]
mod failure;
#[allow(dead_code, reason = "the target uses a part")]
#[path = "../../../crates/orogen-cli/src/values/mod.rs"]
mod values;

/// A target: it takes any bytes.
pub type Target = fn(&[u8]);

/// All targets by their names, which are those of their folders in `fuzz/corpus`.
pub const TARGETS: &[(&str, Target)] = &[
    ("author_map", author_map::run),
    ("dem", dem::run),
    ("drawing", drawing::run),
    ("journal", journal::run),
    ("network", network::run),
    ("options", options::run),
    ("palette", palette::run),
    ("place", place::run),
    ("plan", plan::run),
    ("points", points::run),
    ("recipe", recipe::run),
    ("sidecar", sidecar::run),
    ("solution", solution::run),
    ("tileset", tileset::run),
    ("zarr", zarr::run),
];
