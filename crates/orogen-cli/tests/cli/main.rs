//! Tests of the `orogen` command: the built program, run in temporary folders, and its parsers.
// Clippy detects test functions, but not that this whole file contains tests.
#![allow(clippy::unwrap_used, clippy::panic)]

// The parsers are not part of the library's public interface, so they are compiled into the tests.
#[allow(dead_code, reason = "the tests use a part")]
#[path = "../../src/failure.rs"]
mod failure;
#[allow(dead_code, reason = "the tests use a part")]
#[path = "../../src/values/mod.rs"]
mod values;

mod author_maps;
mod bad_places;
mod bad_recipes;
mod blocks;
mod book;
mod build;
mod cache;
mod check;
mod commands;
mod compare;
mod documents;
mod export;
mod generate;
mod harness;
mod jobs;
mod layers;
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
mod parsers;
mod places;
mod progress;
mod refine;
mod render;
mod roads;
mod scatter;
mod serve;
mod surfaces;
mod tilemap;
mod view;
mod watch;
mod water;
