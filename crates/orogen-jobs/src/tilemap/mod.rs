//! Tilemaps: terrain classes of a world drawn with tiles, as files for map editors, engines and programs.
//!
//! [`job::TilemapJob`] makes a [`map::Tilemap`] from a world, in memory or in bounded memory. [`art`] draws the
//! built-in tilesets, and [`load`] reads others. [`tiled`], [`ldtk`], [`godot`], [`preview`] and [`table`] write the
//! map; [`files`] writes all of these into a folder.

mod class_rows;
mod drawing;
#[doc(hidden)]
pub mod files;
#[doc(hidden)]
pub mod godot;
#[doc(hidden)]
pub mod job;
#[doc(hidden)]
pub mod ldtk;
#[doc(hidden)]
pub mod load;
#[doc(hidden)]
pub mod map;
mod map_objects;
#[doc(hidden)]
pub mod preview;
#[doc(hidden)]
pub mod table;
#[doc(hidden)]
pub mod tiled;
mod tilemap_options;
#[doc(hidden)]
pub mod tileset_source;

pub use files::WrittenMap;
pub use job::TilemapJob;
pub use map::{TileLayer, Tilemap};
pub use tileset_source::TilesetSource;

#[doc(hidden)]
pub use orogen_output::tilemap::{art, tileset};

#[cfg(test)]
mod tests;
