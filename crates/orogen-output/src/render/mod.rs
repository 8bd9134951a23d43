//! Pictures of the land as it would be seen: perspective, sun and shadow, sky, haze and water, on the CPU alone.
//!
//! A [`Scene`](scene::Scene) is the land with its light, prepared once; it is painted from any number of
//! [`Camera`](camera::Camera)s. Nothing in it is left to chance: every pixel depends on its place in the picture alone, so a
//! picture has the same bytes on any machine and any number of threads.

pub mod camera;
mod grain;
mod ground;
pub(crate) mod march;
pub mod relief;
pub mod scene;
mod shade;
pub(crate) mod sky;
mod skylight;
mod tone;
pub(crate) mod vector;
mod water;

#[cfg(test)]
mod tests;
