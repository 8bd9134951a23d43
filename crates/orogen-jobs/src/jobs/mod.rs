//! What is drawn of a world, as one job each: a map sheet, a rendered picture, blocks.
//!
//! Prepare a recipe with a job, open its world, then write to a file. Layers and packages for game engines have jobs of
//! their own in [`export`](crate::export), and maps of tiles in [`tilemap`](crate::tilemap).

pub mod blocks;
mod color_bar;
mod drawn_map;
mod finite;
pub mod map;
mod map_names;
mod map_options;
mod map_water;
pub mod render;
mod render_options;
pub mod sheet_format;
