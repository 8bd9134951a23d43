//! Colors for heights: ramps between stops, the atlas tint for land and sea, palettes by name and from files.
//!
//! Colors between stops are mixed in Oklab (B. Ottosson, 2020), which is perceptually uniform: a mix of green and
//! brown does not turn grey. Results are in linear light, so that shading can multiply them; [`color::Encoder`]
//! converts them to bytes.

pub(crate) mod cpt;
pub(crate) mod gdaldem;
pub(crate) mod gpl;
pub mod named;
pub mod names;
pub mod own;
pub(crate) mod qgis;
pub mod read;
#[cfg(test)]
mod tint_tests;

pub use orogen_codec::palette::{color, fitted, histogram, palette, ramp, tint};
