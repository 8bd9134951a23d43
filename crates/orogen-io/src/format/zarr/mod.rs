//! Zarr v3: arrays in chunks, each a file, in folders that describe themselves.
//!
//! Zarr core specification 3.1; chunks by the codecs `bytes` (little-endian) and `blosc` (byte shuffle, then zlib). The shuffle brings
//! alike bytes of neighbouring samples together: a height map takes half of what plain gzip makes of it, in half the time.
//!
//! **Where it lies.** Coordinates are arrays of their own, in metres: `x` grows east, `y` is the northing and falls from row to row,
//! as in a GeoTIFF of the same window; of a world on a map, both are coordinates of that map, and each array tells its system (`_CRS`, `crs_wkt`). So an array looks like a picture, and what reads both finds the same sample at the same place.

pub mod blosc;
pub mod metadata;
pub(crate) mod reader;
pub(crate) mod unpack;
