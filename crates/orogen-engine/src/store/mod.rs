//! Solutions and tiles of levels, in memory and in a store for later runs.

mod entry;
mod entry_key;
#[doc(hidden)]
pub mod folder;
pub(crate) mod grids;
pub(crate) mod kept;
pub(crate) mod level_tile;
pub(crate) mod level_tiles;
#[doc(hidden)]
pub mod listing;
#[doc(hidden)]
pub mod memory;
#[doc(hidden)]
pub mod solution_store;
pub(crate) mod solutions;
mod stored_tiles;
mod tile_entry;

pub use folder::FolderStore;
pub use listing::Stored;
pub use memory::MemoryStore;
pub use solution_store::{EntryKey, SolutionStore};

/// Readers of stored solutions and tiles, for the fuzz targets.
#[doc(hidden)]
pub mod fuzzing {
    pub use super::entry::{read, windows};
    pub use super::tile_entry::windows as tile_windows;
}
