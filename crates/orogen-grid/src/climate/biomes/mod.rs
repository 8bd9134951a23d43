//! Classes of climates and biomes.

#[doc(hidden)]
pub mod class;
mod holdridge;
mod koppen_geiger;
#[doc(hidden)]
pub mod scheme;
mod whittaker;

pub use class::{Class, Climate, WATER};
pub use scheme::Scheme;
