//! Coordinate reference systems in files: EPSG codes, GeoTIFF keys, and the well-known text (WKT 1) of `.prj` files.
//!
//! [`keys`] converts in both directions: [`keys::to_wkt`] writes the text for a sidecar of a file without
//! georeferencing, [`keys::of_wkt`] reads it. `epsg` contains systems with their parameters, the [`registry`] contains
//! all systems by their codes. `rebuilt` writes the known keys of a file again, without its vertical system:
//! [`vertical`] determines its unit, and heights are converted to metres. Any other text is kept unchanged, in the key
//! where ESRI's programs and GDAL expect it. Coordinates are never transformed.

pub(crate) mod arc_info;
pub(crate) mod epsg;
#[doc(hidden)]
pub mod keys;
pub(crate) mod rebuilt;
#[doc(hidden)]
pub mod registry;
pub(crate) mod system;
#[doc(hidden)]
pub mod unit;
#[doc(hidden)]
pub mod vertical;
pub(crate) mod wkt;

#[doc(hidden)]
pub use keys::GeoKeys;
pub use registry::Crs;
