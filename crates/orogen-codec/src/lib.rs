//! The inner loops of file formats over samples and bytes, and the buffers that they need. Programs use this crate as a
//! part of `orogen-io`, which contains the file formats.
//!
//! - [`mod@format`]: compression, pictures, samples and features as bytes and text, and file formats that need little
//!   more
//! - [`palette`]: colors of heights
//! - [`raster`]: a layer in memory or in pages on disk, with the same bits in both cases
//! - [`read_at`]: bytes that are read by position, from any thread
//! - [`spool`]: byte buffers in memory or on disk; [`records`]: a sequence of values, compressed in such a buffer
//! - [`samples`]: conversion of samples to bytes, for whole rows at a time; [`fill`]: interpolation of missing samples
#![forbid(unsafe_code)]

#[doc(hidden)]
pub mod buffered;
#[doc(hidden)]
pub mod fill;
#[doc(hidden)]
pub mod format;
#[doc(hidden)]
pub mod fs;
#[doc(hidden)]
pub mod full_disk;
#[doc(hidden)]
pub mod pages;
#[doc(hidden)]
pub mod palette;
#[doc(hidden)]
pub mod raster;
#[doc(hidden)]
pub mod read_at;
#[doc(hidden)]
pub mod records;
#[doc(hidden)]
pub mod samples;
#[doc(hidden)]
pub mod spool;
#[doc(hidden)]
pub mod temporary;
#[doc(hidden)]
pub mod test_folder;
