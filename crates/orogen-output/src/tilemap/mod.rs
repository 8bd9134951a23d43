//! Tilemaps: terrain classes of a world drawn with tiles, as files for Tiled and for programs.
//!
//! [`job::TilemapJob`] makes a [`job::Tilemap`] from a world; [`art`] draws the tilesets of the program; [`tiled`], [`preview`] and [`table`]
//! write the map.

pub mod art;
pub mod job;
pub mod preview;
pub mod standard;
pub mod table;
pub mod tiled;
pub mod tileset;
