//! The file formats of terrain: elevation models, images, vector features and palettes, read and written.
//!
//! - [`mod@format`]: one module per file format. Writers stream; readers check sizes stated in a file against its length.
//! - [`dem`]: elevation models in any format, single or as mosaics, resampled to square cells in metres, with voids filled.
//! - [`palette`]: colour ramps by name and from files.
//! - [`mod@file`]: files written atomically, and the policy of what they may replace.
//! - [`raster`]: a layer in memory or in pages on disk; both give the same bits.
//! - [`read_at`]: bytes that are read by position, from any thread.
//! - [`spool`]: byte buffers in memory or on disk; [`records`]: values in order, packed in such a buffer.
#![forbid(unsafe_code)]

pub mod dem;
pub mod file;
pub mod format;
#[doc(hidden)]
pub mod fs;
#[doc(hidden)]
pub mod full_disk;
pub mod open;
#[doc(hidden)]
pub mod pages;
pub mod palette;
pub mod raster;
pub mod read_at;
pub mod records;
#[doc(hidden)]
pub mod samples;
pub mod spool;
#[doc(hidden)]
pub mod test_folder;
