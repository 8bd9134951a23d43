//! Solutions in memory, and in a store for later runs.

mod entry;
pub mod folder;
pub(crate) mod grids;
pub mod listing;
pub mod memory;
pub mod solution_store;
pub(crate) mod solutions;

/// Readers of stored solutions, for the fuzz targets.
#[doc(hidden)]
pub mod fuzzing {
    pub use super::entry::{read, windows};
}
