//! What a user orders of a world, from its recipe to its files.
//!
//! - [`export`]: a registry of layers and formats, for every front end.
//! - [`jobs`]: a map sheet or a rendered picture of a world as one job.
//! - [`builder`]: worlds of any size into files, with resume.
//! - [`tilemap`]: terrain classes drawn with tiles.
//! - [`fit`]: recipes like a real place.
//! - [`graph_layout`]: boxes and wires in columns.
//!
//! It reads options, asks for layers, and puts files in place. What computes samples is in the crates below, so that this one can be
//! compiled fast instead of to be fast.
#![forbid(unsafe_code)]

pub mod builder;
pub mod export;
pub mod fit;
#[doc(hidden)]
pub mod graph_layout;
pub mod jobs;
pub mod tilemap;
