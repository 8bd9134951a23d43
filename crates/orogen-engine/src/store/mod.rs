//! Solutions in memory, and in a folder for later runs.

pub mod cache;
mod entry;
pub(crate) mod grids;
pub mod listing;
pub(crate) mod solutions;

/// Readers of stored solutions, for the fuzz targets.
#[doc(hidden)]
pub mod fuzzing {
    pub use super::entry::{read, windows};
}
