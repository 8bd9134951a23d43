//! What can be said about a grid: pure functions from grids to grids and numbers.

pub mod aspect;
pub mod curvature;
pub mod geomorphons;
pub mod hillshade;
pub mod hypsometry;
pub mod slope;
pub mod summary;
