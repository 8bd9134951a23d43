//! File formats, one per module. Writers stream to any [`Write`](std::io::Write) and keep only a few rows in memory.
//! Readers of heights ([`import`]) check sizes stated in a file against its length before they allocate memory.

#[doc(hidden)]
pub mod affine;
pub mod asc;
#[doc(hidden)]
pub mod aux_xml;
#[doc(hidden)]
pub mod band;
#[doc(hidden)]
pub mod content;
#[doc(hidden)]
pub mod contour_svg;
pub mod crs;
pub mod csv;
#[doc(hidden)]
pub mod dem;
#[doc(hidden)]
pub mod drawing;
pub(crate) mod dted;
pub(crate) mod ehdr;
pub(crate) mod exr_reader;
#[doc(hidden)]
pub mod features;
pub mod fgb;
#[doc(hidden)]
pub mod fmg;
#[doc(hidden)]
pub mod foreign;
pub mod geojson;
pub mod geotiff;
pub mod gpkg;
pub(crate) mod grey;
pub mod hgt;
#[doc(hidden)]
pub mod import;
pub(crate) mod netcdf;
pub mod network;
mod noted;
#[doc(hidden)]
pub mod notes;
#[doc(hidden)]
pub mod pgm;
#[doc(hidden)]
pub mod pmtiles;
#[doc(hidden)]
pub mod points;
pub mod raw;
#[doc(hidden)]
pub mod sidecar;
#[doc(hidden)]
pub mod svg;
mod svg_shapes;
#[doc(hidden)]
pub mod tres;
#[doc(hidden)]
pub mod vrt;
#[doc(hidden)]
pub mod world_file;
#[doc(hidden)]
pub mod xml;
pub(crate) mod xyz;
#[doc(hidden)]
pub mod zarr;

pub use affine::{Affine, Lattice};
#[doc(hidden)]
pub use band::BandMetadata;
pub use crs::Crs;
pub use dem::{Dem, Georeference, Placement, Request};
pub use import::{is_dem, read};
pub use points::{NamedPoint, NamedPoints};
#[doc(hidden)]
pub use sidecar::Sidecar;

#[doc(hidden)]
pub use orogen_codec::format::weights;
#[doc(hidden)]
pub use orogen_codec::format::{
    anvil, encoding, exr, gif, gzip, half, lerc, levels, luanti, mvt, nbt, npy, outlines, png, schem, vox, zip_writer,
};
pub(crate) use orogen_codec::format::{
    conversion, coordinates, exr_block, feature_text, flatbuffer, geojson_reader, gpkg_reader, gpkg_rows, grey_rows,
    input, metres16, number, sorted_features, sqlite, stored, svg_path, words, xyz_rows, zip,
};
