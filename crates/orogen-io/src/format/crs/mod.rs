//! Coordinate reference systems as files name them: EPSG codes, the keys of GeoTIFF, and the well-known text (WKT 1) of `.prj` files.
//!
//! [`keys`] takes both ways: [`keys::to_wkt`] writes the text that stands beside a file without georeferencing of its own, [`keys::of_wkt`] reads it. Known
//! by their parameters are the systems of `epsg`, by their codes all of the [`registry`]; any other text is kept as it is, in the key where ESRI's programs
//! and GDAL look for it. No coordinate is ever transformed here.

pub(crate) mod arc_info;
pub(crate) mod epsg;
pub mod keys;
pub mod registry;
pub(crate) mod system;
pub mod unit;
pub(crate) mod wkt;
