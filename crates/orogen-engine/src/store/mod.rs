//! What has been solved: in memory, and in a folder that later runs find again.

pub mod cache;
mod entry;
pub(crate) mod grids;
pub mod listing;
pub(crate) mod solutions;
