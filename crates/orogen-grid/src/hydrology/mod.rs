//! Hydrology: depressions, drainage, drainage areas, lakes, rivers and their erosion. Pure functions on grids, one
//! algorithm per file.

pub mod above_drainage;
pub mod accumulation;
pub mod basins;
pub mod breach;
pub mod creep;
pub mod direction;
pub mod drainage;
pub mod erosion;
pub mod fill;
pub mod flats;
pub mod lakes;
pub mod least_cost;
pub mod outlets;
pub mod points;
pub mod receivers;
pub mod rivers;
#[doc(hidden)]
pub mod samples;
pub mod statistics;
pub mod steepest;
pub mod strahler;
pub mod stream_power;
pub mod watersheds;
pub mod wetness;
