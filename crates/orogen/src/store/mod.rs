//! Solutions in memory, and in a folder for later runs.

pub mod cache;
mod entry;
pub mod grids;
pub mod listing;
pub mod solutions;
