//! Zarr v3: arrays in chunks, each chunk a file, in folders with metadata.
//!
//! Zarr core specification 3.1, with the codecs `bytes` (little-endian) and `blosc` (byte shuffle, then zlib). The
//! shuffle groups similar bytes of neighboring samples: a height map takes half the space and half the time of plain
//! gzip.
//!
//! **Position.** Coordinates are separate arrays, in metres: `x` increases eastward, `y` is the northing and decreases
//! from row to row, as in a GeoTIFF of the same window. For a world on a map, both are coordinates of that map, and
//! each array states its coordinate system (`_CRS`, `crs_wkt`). Rows are in the order of a picture, and samples have
//! the same positions as in the GeoTIFF.

#[doc(hidden)]
pub mod metadata;
pub(crate) mod reader;

pub use orogen_codec::format::zarr::blosc;
pub(crate) use orogen_codec::format::zarr::unpack;
