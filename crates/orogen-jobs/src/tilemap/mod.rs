//! Tilemaps: terrain classes of a world drawn with tiles, as files for map editors, engines and programs.
//!
//! [`job::TilemapJob`] makes a [`map::Tilemap`] from a world, in memory or in bounded memory; [`art`] draws the
//! tilesets of the program, and [`load`] reads those of others; [`tiled`], [`ldtk`], [`godot`], [`preview`] and
//! [`table`] write the map; [`files`] puts all of it into a folder.

mod class_rows;
mod drawing;
pub mod files;
pub mod godot;
pub mod job;
pub mod ldtk;
pub mod load;
pub mod map;
mod map_objects;
pub mod preview;
pub mod table;
pub mod tiled;
mod tilemap_options;
pub mod tileset_source;

#[doc(inline)]
pub use orogen_output::tilemap::{art, tileset};

#[cfg(test)]
mod tests;
