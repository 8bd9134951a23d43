//! File formats, one per file. Writers stream to any [`Write`](std::io::Write) and hold a few rows at a time. Readers
//! of heights ([`import`]) check sizes stated in a file against its length before they allocate memory.

pub mod affine;
pub mod asc;
pub mod aux_xml;
pub mod contour_svg;
pub mod crs;
mod deflate;
pub mod dem;
pub mod encoding;
pub mod exr;
pub(crate) mod exr_reader;
pub mod features;
pub mod fgb;
pub(crate) mod flatbuffer;
pub mod geojson;
pub mod geotiff;
pub mod gif;
pub mod gpkg;
pub(crate) mod grey;
pub mod half;
pub mod hgt;
pub mod import;
pub mod lerc;
pub mod levels;
mod noted;
pub mod npy;
pub(crate) mod packed_tree;
pub mod pgm;
pub mod png;
pub mod raw;
pub mod sidecar;
pub(crate) mod sqlite;
pub mod svg;
pub mod vrt;
pub mod world_file;
pub mod zarr;
