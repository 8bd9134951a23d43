//! Vector features of water and relief: rivers that end at the shores of lakes and of the sea, lakes, watersheds,
//! coasts and summits.
//!
//! [`water::Water`] computes the drainage once, or takes it from a known network. All features are derived from it.
//! Positions are columns and rows of its grid.

#[doc(hidden)]
pub mod clip;
#[doc(hidden)]
pub mod given;
#[doc(hidden)]
pub mod joints;
#[doc(hidden)]
pub mod network;
#[doc(hidden)]
pub mod outlines;
#[doc(hidden)]
pub mod peaks;
#[doc(hidden)]
pub mod pour_points;
#[doc(hidden)]
pub mod rings;
#[doc(hidden)]
pub mod rivers;
#[doc(hidden)]
pub mod shores;
#[doc(hidden)]
pub mod summits;
#[doc(hidden)]
pub mod water;
#[doc(hidden)]
pub mod watersheds;
#[doc(hidden)]
pub mod zones;

pub use network::Network;
pub use outlines::outlines;
pub use rivers::{Mouth, River, rivers};
pub use shores::Shores;
pub use summits::{Summit, summits};
pub use water::Water;
pub use watersheds::{Watersheds, watersheds};
pub use zones::ZoneStats;
