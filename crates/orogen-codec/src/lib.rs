//! What file formats compute sample by sample and byte by byte, and the buffers that they need. Programs use it as
//! parts of `orogen-io`, which holds the formats: what they read and write once a file or a row.
//!
//! - [`mod@format`]: compression, pictures, samples and features as bytes and text, and the formats that consist of
//!   little else.
//! - [`palette`]: colors of heights.
//! - [`raster`]: a layer in memory or in pages on disk; both give the same bits.
//! - [`read_at`]: bytes that are read by position, from any thread.
//! - [`spool`]: byte buffers in memory or on disk; [`records`]: values in order, packed in such a buffer.
//! - [`samples`]: samples as bytes, whole rows at a time; [`fill`]: missing samples from those around.
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
