//! Hydrology: depressions, drainage, drainage areas, lakes, rivers and their erosion. Pure functions on grids, one
//! algorithm per file.

#[doc(hidden)]
pub mod above_drainage;
#[doc(hidden)]
pub mod accumulation;
#[doc(hidden)]
pub mod basins;
#[doc(hidden)]
pub mod breach;
#[doc(hidden)]
pub mod creep;
#[doc(hidden)]
pub mod deposition;
#[doc(hidden)]
pub mod direction;
#[doc(hidden)]
pub mod drainage;
#[doc(hidden)]
pub mod erosion;
#[doc(hidden)]
pub mod fill;
#[doc(hidden)]
pub mod flats;
#[doc(hidden)]
pub mod lakes;
#[doc(hidden)]
pub mod least_cost;
#[doc(hidden)]
pub mod outlets;
#[doc(hidden)]
pub mod points;
#[doc(hidden)]
pub mod receivers;
#[doc(hidden)]
pub mod rivers;
#[doc(hidden)]
pub mod samples;
mod spread;
#[doc(hidden)]
pub mod statistics;
#[doc(hidden)]
pub mod steepest;
#[doc(hidden)]
pub mod strahler;
#[doc(hidden)]
pub mod stream_power;
#[doc(hidden)]
pub mod watersheds;
#[doc(hidden)]
pub mod wetness;

pub use above_drainage::{AboveDrainage, above_drainage};
pub use accumulation::{Accumulation, accumulate};
#[doc(hidden)]
pub use basins::{Basins, Spill};
pub use breach::breach;
pub use creep::creep;
pub use direction::Convention;
pub use drainage::{Drainage, route_carving};
pub use erosion::Erosion;
pub use fill::fill;
pub use lakes::{Lake, Lakes, lakes};
pub use outlets::Outlets;
pub use receivers::Receivers;
#[doc(hidden)]
pub use rivers::{Reach, Streams};
pub use steepest::receivers;
pub use strahler::strahler_orders;
pub use stream_power::{StreamPower, Substrate};
pub use watersheds::watersheds;
pub use wetness::{ls_factor, stream_power, wetness_index};
