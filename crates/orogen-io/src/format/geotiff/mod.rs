//! GeoTIFF, laid out for the cloud (COG): the samples as they are, with coarser overviews, readable in parts.
//!
//! TIFF 6.0 with Adobe's Technical Note 3 (the predictor of floats), BigTIFF where a file passes 4 GiB, OGC GeoTIFF 1.1 (OGC
//! 19-008r4), OGC COG 1.0 (OGC 21-026). Written: one band of f32, little-endian, in tiles compressed with deflate with predictor 3.
//!
//! **Order.** A ghost area that tells readers what to count on, then every directory from the full raster to the coarsest
//! overview, then the samples from the coarsest overview to the full raster. So a reader that wants a preview gets it from the
//! file's first kilobytes. Each tile has its length in the four bytes before it and its own last four bytes repeated behind it.
//!
//! **Where it lies.** Where a real place lies that was read from a file: its map and coordinate system are kept. Else in local metres without an EPSG code: easting = x, northing = -y, one user-defined system of metres. Samples
//! stand at lattice points, so the raster is *pixel-is-point*: the tie point is the first sample itself. Readers that think in
//! areas (GDAL, rasterio) put the corner of the raster half a cell to the north-west of it, and the middle of their first pixel
//! on the sample.
//!
//! **Overviews** halve each side, rounded up, until one tile holds everything. Every reader spreads an overview over the whole of
//! the raster's area, so that its samples stand in the *middle* of those they stand for. Picking every second sample would move
//! the terrain by half a cell at the first overview and by nearly half an overview's cell at the coarse ones; a mean does not. So an
//! overview's sample is the mean over its own area: of four samples, and where a side is odd, of all that it touches, weighted by how
//! much of them it covers.
//!
//! The bytes depend on the samples, the window and the options, not on the number of threads nor on the size of the pieces in which
//! the rows arrive.

mod directory;
mod entries;
pub mod options;
#[doc(hidden)]
pub mod overview;
mod place;
#[doc(hidden)]
pub mod pyramid;
pub mod reader;
#[doc(hidden)]
pub mod tile;
pub(crate) mod unpack;
pub mod writer;

#[cfg(test)]
mod tests;
