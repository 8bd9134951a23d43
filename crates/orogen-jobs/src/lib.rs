//! Exports, builds, map sheets, renders, tilemaps, frames of erosion, analyses, searches and fits of worlds as jobs.
//!
//! - [`export`]: a registry of layers and formats, for every front end.
//! - [`jobs`]: a map sheet, a rendered picture, frames of erosion or statistics of a world as one job.
//! - [`options`]: declarations of options, from which front ends derive theirs.
//! - [`builder`]: worlds of any size written to files, with resume.
//! - [`tilemap`]: terrain classes drawn with tiles.
//! - [`fit`]: recipes fitted to a real place.
//! - [`locate`]: places that satisfy conditions.
//! - [`graph_layout`]: boxes and wires in columns.
//!
//! A job reads options, requests layers, and puts files in place. The crates below it process the samples. This crate
//! is therefore compiled without optimization, which reduces its compile time to an eighth.
#![forbid(unsafe_code)]

#[doc(hidden)]
pub mod author_map;
pub mod builder;
pub mod export;
pub mod fit;
#[doc(hidden)]
pub mod graph_layout;
pub mod jobs;
pub mod locate;
pub mod options;
pub mod tilemap;
