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

pub mod buffered;
pub mod fill;
pub mod format;
pub mod fs;
pub mod full_disk;
pub mod pages;
pub mod palette;
pub mod raster;
pub mod read_at;
pub mod records;
pub mod samples;
pub mod spool;
pub mod temporary;
pub mod test_folder;
