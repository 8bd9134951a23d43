//! Colors of heights: ramps between stops, and the atlas tint for land and sea.

pub mod atlas;
pub mod color;
pub mod fitted;
pub mod histogram;
#[allow(clippy::module_inception, reason = "the room is about palettes, the file about the one")]
pub mod palette;
pub mod ramp;
pub mod tint;
