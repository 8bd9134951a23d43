//! Painting on other devices than the processor.

use std::fmt;
use std::ops::Range;

use super::camera::Camera;
use super::scene::Scene;
use super::skylight::{Shed, SkylightInput};
use orogen_grid::error::Result;
use orogen_grid::progress::Progress;

/// A device that paints scenes, such as a graphics card. Its pictures look like those of [`Scene::paint`], but may differ
/// in their last bits.
pub trait Painter: Send + Sync {
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

    /// Computes the light of the sky on every sample of the land; `None` if the processor must.
    ///
    /// # Errors
    /// If the work is cancelled.
    fn skylight(&self, _input: &SkylightInput, _progress: &Progress) -> Result<Option<Vec<Shed>>> {
        Ok(None)
    }
}

/// The result of a [`Painter`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Painted {
    /// All rows were painted.
    Done,
    /// The device could not paint them, and why. The bytes have no meaning.
    Refused(String),
}

impl fmt::Debug for dyn Painter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Painter")
    }
}
