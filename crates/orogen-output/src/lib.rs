//! What is made of Orogen's terrains: pictures, sheets, meshes, reports and files.
//!
//! - [`map`]: colours on the ground, shaded relief.
//! - [`sheet`]: map sheets with contours, grid, scale and legend, as PNG, SVG and PDF.
//! - [`render`]: perspective pictures with sky, water and shadows.
//! - [`mesh`]: triangles of a grid, as GLB, OBJ, PLY, STL and 3MF.
//! - [`export`]: a registry of layers and formats, for every front end.
//! - [`jobs`]: a map sheet or a rendered picture of a world as one job.
//! - [`builder`]: worlds of any size into files, with resume.
//! - [`survey`]: a terrain in numbers, beside what real land is like.
//! - [`fit`]: recipes like a real place.
//! - [`tilemap`]: terrain classes drawn with tiles.
//! - [`graph_layout`]: boxes and wires in columns.
//! - [`blocks`]: worlds of blocks, for block games and voxel editors.
#![forbid(unsafe_code)]

pub mod blocks;
pub mod builder;
pub mod export;
pub mod fit;
#[doc(hidden)]
pub mod graph_layout;
pub mod jobs;
pub mod map;
mod markup;
pub mod mesh;
#[doc(hidden)]
pub mod noise_pictures;
mod proportions;
pub mod render;
pub mod sheet;
pub mod survey;
pub mod tilemap;
