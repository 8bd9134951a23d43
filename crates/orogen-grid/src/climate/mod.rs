//! Climate: temperature, orographic rain, evapotranspiration and classes of climates and biomes.

pub mod biomes;
pub mod evapotranspiration;
mod lattice;
pub mod orographic;
pub mod temperature;
pub mod year;
