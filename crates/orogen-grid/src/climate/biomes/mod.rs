//! Classes of climates and biomes.

pub mod class;
mod holdridge;
mod koppen_geiger;
pub mod scheme;
mod whittaker;
