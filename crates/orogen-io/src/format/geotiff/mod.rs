//! GeoTIFF in the layout of a Cloud-Optimized GeoTIFF (COG): f32 samples with overviews, readable in parts.
//!
//! TIFF 6.0 with Adobe's Technical Note 3 (floating-point predictor), BigTIFF for files larger than 4 GiB, OGC GeoTIFF
//! 1.1 (OGC 19-008r4), OGC COG 1.0 (OGC 21-026). Files have one band of f32, little-endian, in tiles compressed with
//! deflate and predictor 3.
//!
//! **Order.** A ghost area with properties for readers, then all directories from the full raster to the coarsest
//! overview, then the samples from the coarsest overview to the full raster. A reader gets a preview from the first
//! kilobytes of the file. Each tile is preceded by its length in four bytes and followed by a copy of its last four
//! bytes.
//!
//! **Position.** A real place keeps its map and coordinate system. Otherwise coordinates are local metres without an
//! EPSG code: easting = x, northing = -y, in a user-defined system of metres. Samples are lattice points, so the raster
//! is *pixel-is-point*: the tie point is the first sample. Readers that treat pixels as areas (GDAL, rasterio) place
//! the corner of the raster half a cell to the north-west of it, and the center of their first pixel on the sample.
//!
//! **Overviews** halve each side, rounded up, until one tile holds the whole raster. Every reader stretches an overview
//! over the whole area of the raster, so its samples are at the *center* of the samples that they represent. Decimation
//! (every second sample) would shift the terrain by half a cell at the first overview and by nearly half an overview's
//! cell at the coarse ones; averaging does not. A sample of an overview is therefore the mean over its own area: of
//! four samples or, where a side is odd, of all samples that it overlaps, weighted by the covered area.
//!
//! The bytes depend on the samples, the window and the options, but not on the number of threads or the pieces in which
//! rows arrive.

mod blocks;
mod directory;
mod entries;
pub(crate) mod mask;
#[doc(hidden)]
pub mod options;
mod place;
#[doc(hidden)]
pub mod pyramid;
#[doc(hidden)]
pub mod reader;
#[doc(hidden)]
pub mod writer;

pub use options::Options;
pub use writer::Writer;

pub(crate) use orogen_codec::format::geotiff::unpack;
#[doc(hidden)]
pub use orogen_codec::format::geotiff::{overview, tile};

#[cfg(test)]
mod reader_tests;
#[cfg(test)]
mod tests;
