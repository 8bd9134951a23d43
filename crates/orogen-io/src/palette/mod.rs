//! Colours for heights: ramps between stops, the atlas tint for land and sea, palettes by name and from files.
//!
//! Colours between stops are mixed in Oklab (B. Ottosson, 2020), where equal steps look equal and a mix of green and brown does
//! not turn grey. What comes out is linear light, so that shading may multiply it; [`color::Encoder`] makes the bytes.

pub(crate) mod atlas;
pub mod color;
pub(crate) mod cpt;
pub mod fitted;
pub(crate) mod gdaldem;
pub(crate) mod gpl;
pub mod histogram;
pub mod named;
pub mod names;
pub(crate) mod own;
#[allow(clippy::module_inception, reason = "the room is about palettes, the file about the one")]
pub mod palette;
pub mod ramp;
pub mod read;
pub mod tint;
