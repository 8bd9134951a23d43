//! Climate: temperature, orographic rain, evapotranspiration and classes of climates and biomes.

pub mod biomes;
#[doc(hidden)]
pub mod evapotranspiration;
mod lattice;
#[doc(hidden)]
pub mod orographic;
#[doc(hidden)]
pub mod temperature;
#[doc(hidden)]
pub mod year;

pub use biomes::{Class, Climate, Scheme};
pub use evapotranspiration::{humidity, potential};
pub use orographic::OrographicRain;
pub use temperature::Temperature;
pub use year::Year;
