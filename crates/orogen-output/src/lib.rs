//! Outputs made from Orogen's terrains: pictures, sheets, meshes, blocks and reports.
//!
//! - [`map`]: colors on the ground, shaded relief.
//! - [`sheet`]: map sheets with contours, grid, scale and legend, as PNG, SVG and PDF.
//! - [`render`]: perspective pictures with sky, water and shadows.
//! - [`mesh`]: triangles of a grid, as GLB, OBJ, PLY, STL and 3MF.
//! - [`survey`]: statistics of a terrain, compared with real land.
//! - [`tilemap`]: tiles and their pictures.
//! - [`blocks`]: worlds of blocks, for block games and voxel editors.
#![forbid(unsafe_code)]

pub mod blocks;
pub mod map;
#[doc(hidden)]
pub mod markup;
pub mod mesh;
#[doc(hidden)]
pub mod noise_pictures;
#[doc(hidden)]
pub mod proportions;
pub mod render;
pub mod sheet;
pub mod survey;
pub mod tilemap;
#[doc(hidden)]
pub mod vector_tile;
