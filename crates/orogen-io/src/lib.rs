//! The file formats of terrain: elevation models, images, vector features and palettes, read and written.
//!
//! - [`mod@format`]: one file format a module. Writers stream; readers never trust a file further than its bytes go.
//! - [`dem`]: elevation models of any format opened as one: mosaics, in square metres, without voids.
//! - [`palette`]: colour ramps by name and from files.
//! - [`mod@file`]: files written atomically, and the policy of what they may replace.
//! - [`raster`]: a layer in memory or in pages on disk, with the same bits.
//! - [`read_at`]: bytes that are read by position, from any thread.
//! - [`spool`]: bytes that wait in memory or on disk until they are written.
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
pub mod spool;
#[doc(hidden)]
pub mod test_folder;
