//! Tests of the library as a program uses it.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test that fails panics")]

mod allocations;
mod chunks;
mod damaged_dems;
mod dem_windows;
mod dems;
mod fit;
mod flight;
mod front_door;
mod golden;
mod graphs;
mod images;
mod large_water;
mod laws;
mod level_tiles;
mod meshes;
mod neighbors;
#[cfg(target_os = "linux")]
mod peaks;
mod prints;
mod programs;
mod progress;
mod properties;
mod recipes;
mod registered_ops;
mod resample;
mod samplers;
mod sessions;
mod stores;
mod support;
mod survey;
mod tiles;
mod uses;
mod values;
mod volumes;
mod water;
mod water_features;
mod water_mosaics;
mod water_network;
