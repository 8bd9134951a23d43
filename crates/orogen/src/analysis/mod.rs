//! What can be said about a grid: pure functions from grids to grids and numbers.

pub mod hillshade;
pub mod slope;
pub mod summary;
