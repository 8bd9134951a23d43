//! What can be said about a grid: pure functions from grids to grids and numbers.

pub mod aspect;
pub mod curvature;
pub mod distance;
pub mod finite;
pub mod fourier;
pub mod geomorphons;
pub mod hillshade;
pub mod hypsometry;
pub mod roughness;
pub mod selection;
pub mod sky;
pub mod slope;
pub mod spectrum;
pub mod summary;
