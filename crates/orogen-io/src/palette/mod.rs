//! Colors for heights: ramps between stops, the atlas tint for land and sea, palettes by name and from files.
//!
//! Colors between stops are interpolated in Oklab (B. Ottosson, 2020), which is perceptually uniform: a color between
//! green and brown does not turn gray. Results are in linear light, so that shading can multiply them;
//! [`color::Encoder`] converts them to bytes.

pub(crate) mod cpt;
pub(crate) mod gdaldem;
pub(crate) mod gpl;
#[doc(hidden)]
pub mod named;
#[doc(hidden)]
pub mod names;
#[doc(hidden)]
pub mod own;
pub(crate) mod qgis;
#[doc(hidden)]
pub mod read;

pub use named::{DEFAULT, all, find};
pub use read::read;
#[cfg(test)]
mod tint_tests;

pub use orogen_codec::palette::color::Rgb;
pub use orogen_codec::palette::palette::{Palette, Stop};
pub use orogen_codec::palette::ramp::Ramp;
pub use orogen_codec::palette::tint::Tint;
#[doc(hidden)]
pub use orogen_codec::palette::{color, fitted, histogram, palette, ramp, tint};
