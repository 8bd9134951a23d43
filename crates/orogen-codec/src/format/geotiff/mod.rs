//! Tiles, overviews and rows of GeoTIFF.

pub mod overview;
pub mod tile;
pub mod unpack;
