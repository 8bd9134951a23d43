//! Vector features of water and relief: rivers that end at the shores of lakes and of the sea, lakes, watersheds,
//! coasts, summits.
//!
//! [`water::Water`] computes the drainage once, or takes it from a network that is known; all features are derived from
//! it. Positions are columns and rows of its grid.

pub mod clip;
pub mod given;
pub mod joints;
pub mod network;
pub mod outlines;
pub mod pour_points;
pub mod rings;
pub mod rivers;
pub mod shores;
pub mod summits;
pub mod water;
pub mod watersheds;
#[doc(hidden)]
pub mod zones;
