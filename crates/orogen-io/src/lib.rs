//! The file formats of terrain: elevation models, images, vector features and palettes, read and written.
//!
//! - [`mod@format`]: one module per file format. Writers stream; readers check sizes stated in a file against its
//!   length.
//! - [`dem`]: elevation models in any format, single or as mosaics, resampled to square cells in metres, with voids
//!   filled.
//! - [`palette`]: color ramps by name and from files.
//! - [`mod@file`]: atomic writing of files, and policies for replacing existing files.
//! - [`raster`]: a layer in memory or in pages on disk; both give identical bits.
//! - [`read_at`]: reading bytes by position, from any thread.
//! - [`spool`]: byte buffers in memory or on disk; [`records`]: values in order, packed in such a buffer.
#![forbid(unsafe_code)]

pub mod dem;
pub mod file;
pub mod format;
pub mod open;
pub mod palette;

#[doc(hidden)]
pub use orogen_codec::{fs, full_disk, pages, samples, test_folder};
pub use orogen_codec::{raster, read_at, records, spool};
