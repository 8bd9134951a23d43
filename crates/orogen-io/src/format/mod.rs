//! File formats, one per file. Writers stream to any [`Write`](std::io::Write) and hold a few rows at a time. Readers
//! of heights ([`import`]) check sizes stated in a file against its length before they allocate memory.

pub mod affine;
pub mod asc;
pub mod aux_xml;
pub mod band;
pub mod content;
pub mod contour_svg;
pub mod crs;
pub mod csv;
pub mod dem;
pub mod drawing;
pub(crate) mod dted;
pub(crate) mod ehdr;
pub(crate) mod exr_reader;
pub mod features;
pub mod fgb;
pub mod foreign;
pub mod geojson;
pub mod geotiff;
pub mod gpkg;
pub(crate) mod grey;
pub mod hgt;
pub mod import;
pub(crate) mod netcdf;
mod noted;
pub mod notes;
pub mod pgm;
pub mod points;
pub mod raw;
pub mod sidecar;
pub mod svg;
mod svg_shapes;
pub mod tres;
pub mod vrt;
pub mod world_file;
pub mod xml;
pub(crate) mod xyz;
pub mod zarr;

#[doc(hidden)]
pub use orogen_codec::format::weights;
pub(crate) use orogen_codec::format::{
    conversion, coordinates, exr_block, feature_text, flatbuffer, geojson_reader, gpkg_rows, grey_rows, input,
    metres16, number, sorted_features, sqlite, stored, svg_path, words, xyz_rows, zip,
};
pub use orogen_codec::format::{
    encoding, exr, gif, half, lerc, levels, luanti, npy, outlines, png, schem, vox, zip_writer,
};
