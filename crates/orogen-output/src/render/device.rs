//! Devices that paint pictures instead of the CPU.

use std::fmt;
use std::ops::Range;

use super::camera::Camera;
use super::scene::Scene;
use super::skylight::SkylightDevice;
use orogen_grid::error::Result;
use orogen_grid::progress::Progress;

/// A device that paints scenes, such as a graphics card. Its pictures look like those of [`Scene::paint`], but may
/// differ in their last bits.
pub trait RenderDevice: SkylightDevice + Send + Sync {
    /// Paints some rows of a picture of `size` pixels as sRGB bytes, three per pixel, like [`Scene::paint`].
    ///
    /// # Errors
    /// If the work is cancelled.
    fn paint(
        &self,
        scene: &Scene,
        camera: &Camera,
        size: [usize; 2],
        rows: Range<usize>,
        bytes: &mut [u8],
        progress: &Progress,
    ) -> Result<Painted>;
}

/// The result of a [`RenderDevice`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Painted {
    /// All rows were painted.
    Done,
    /// The device could not paint them, for this reason. The content of the bytes is unspecified.
    Refused(String),
}

impl fmt::Debug for dyn RenderDevice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("RenderDevice")
    }
}
