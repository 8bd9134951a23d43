//! Solutions and tiles of levels, in memory and in a store for later runs.

mod entry;
mod entry_key;
pub mod folder;
pub(crate) mod grids;
pub(crate) mod level_tile;
pub(crate) mod level_tiles;
pub mod listing;
pub mod memory;
pub mod solution_store;
pub(crate) mod solutions;
mod stored_tiles;
mod tile_entry;

/// Readers of stored solutions and tiles, for the fuzz targets.
#[doc(hidden)]
pub mod fuzzing {
    pub use super::entry::{read, windows};
    pub use super::tile_entry::windows as tile_windows;
}
