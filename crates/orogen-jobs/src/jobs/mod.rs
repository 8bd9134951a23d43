//! What is made of a world, as one job each: a map sheet, a rendered picture, blocks, frames of its erosion,
//! statistics, a real place at a smaller cell; and noises.
//!
//! Prepare a recipe with a job, open its world, then write to a file. Layers and packages for game engines have jobs of
//! their own in [`export`](crate::export), maps of tiles in [`tilemap`](crate::tilemap), and fits to real places in
//! [`fit`](crate::fit).

#[doc(hidden)]
pub mod analyze;
#[doc(hidden)]
pub mod blocks;
#[doc(hidden)]
pub mod blocks_folder;
#[doc(hidden)]
pub mod blocks_format;
mod color_bar;
mod drawn_map;
mod finite;
#[doc(hidden)]
pub mod grow;
#[doc(hidden)]
pub mod map;
mod map_names;
mod map_options;
mod map_roads;
#[doc(hidden)]
pub mod map_tiles;
pub mod map_water;
#[doc(hidden)]
pub mod mesh_tiles;
mod minecraft;
#[doc(hidden)]
pub mod noise;
#[doc(hidden)]
pub mod refine;
#[doc(hidden)]
pub mod render;
mod render_options;
#[doc(hidden)]
pub mod sheet_format;
#[doc(hidden)]
pub mod variants;
#[doc(hidden)]
pub mod vector_tiles;

pub use analyze::AnalyzeJob;
pub use blocks::BlocksJob;
pub use blocks_format::BlockFormat;
pub use grow::GrowJob;
pub use map::{MapColors, MapJob};
pub use render::RenderJob;
pub use sheet_format::SheetFormat;
