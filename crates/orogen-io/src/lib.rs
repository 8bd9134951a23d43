//! Files.
#![forbid(unsafe_code)]

pub mod dem;
pub mod file;
pub mod format;
#[doc(hidden)]
pub mod full_disk;
pub mod open;
#[doc(hidden)]
pub mod pages;
pub mod palette;
pub mod raster;
pub mod spool;
