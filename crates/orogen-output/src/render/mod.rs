//! Rendered pictures of the land: perspective, sun and shadow, sky, haze and water, on the CPU.
//!
//! A [`Scene`] is the land with its light, prepared once. Any number of [`Camera`]s can
//! render it. Sampling is deterministic: a pixel depends only on its position in the picture, so a picture has the same
//! bytes on any machine and any number of threads.

mod albedo;
#[doc(hidden)]
pub mod camera;
#[doc(hidden)]
pub mod device;
#[doc(hidden)]
pub mod encode;
mod grain;
mod ground;
#[doc(hidden)]
pub mod lighting;
pub(crate) mod march;
#[doc(hidden)]
pub mod relief;
#[doc(hidden)]
pub mod scene;
mod shade;
#[doc(hidden)]
pub mod shader;
pub(crate) mod sky;
#[doc(hidden)]
pub mod skylight;
mod tone;
pub(crate) mod vector;
mod water;

pub use camera::{Camera, CameraSpec, View};
pub use relief::{Land, Relief};
pub use scene::{Scene, Style};

#[cfg(test)]
mod tests;
