//! Terrain analysis: pure functions from grids to grids and numbers.

pub mod aspect;
pub mod clear_sky;
pub mod curvature;
pub mod distance;
pub mod finite;
pub mod fourier;
pub mod geomorphons;
pub mod halo;
pub mod hillshade;
pub mod hypsometry;
pub mod insolation;
pub mod nine;
pub mod position;
pub mod roughness;
pub mod selection;
pub mod shadow;
pub mod sky;
pub mod slope;
pub mod soil;
pub mod spectrum;
pub mod summary;
pub mod sun;
pub mod viewshed;
