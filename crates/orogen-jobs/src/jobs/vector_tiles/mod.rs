//! Vector tiles of a world: contours, rivers, lakes, summits and scattered objects.
//!
//! `tile_layers` declares the layers and their attributes, `world_features` finds what depends on the whole world, and
//! `job` makes tiles.

mod job;
#[doc(hidden)]
pub mod tile_layers;
mod world_features;

pub use job::VectorTiles;
