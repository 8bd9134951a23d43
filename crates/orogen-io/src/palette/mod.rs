//! Colours for heights: ramps between stops, the atlas tint for land and sea, palettes by name and from files.
//!
//! Colours between stops are mixed in Oklab (B. Ottosson, 2020), which is perceptually uniform: a mix of green and
//! brown does not turn grey. Results are in linear light, so that shading can multiply them; [`color::Encoder`]
//! converts them to bytes.

pub(crate) mod atlas;
pub mod color;
pub(crate) mod cpt;
pub mod fitted;
pub(crate) mod gdaldem;
pub(crate) mod gpl;
pub mod histogram;
pub mod named;
pub mod names;
pub mod own;
#[allow(clippy::module_inception, reason = "the room is about palettes, the file about the one")]
pub mod palette;
pub(crate) mod qgis;
pub mod ramp;
pub mod read;
pub mod tint;
