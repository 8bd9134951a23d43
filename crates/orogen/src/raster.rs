//! A layer over the whole world, wherever it is kept.

use crate::error::{Error, ErrorKind, Result};
use crate::grid::{Grid, Window};
use crate::layer::LayerKind;
use crate::resample;
use orogen_noise::Points;

/// Samples over a window, written and read by parts.
#[derive(Debug)]
pub struct Raster {
    grid: Grid,
}

impl Raster {
    /// A raster in memory.
    pub fn in_memory(grid: Grid) -> Raster {
        Raster { grid }
    }

    /// Where the samples stand.
    pub fn window(&self) -> &Window {
        self.grid.window()
    }

    /// Writes what of `part` lies in the raster.
    ///
    /// # Errors
    /// If the disk takes no more.
    pub fn put(&mut self, part: &Grid) -> Result<()> {
        self.grid.paste(part);
        Ok(())
    }

    /// The samples of a window, which must lie in the raster.
    ///
    /// # Errors
    /// If it does not, or the disk fails.
    pub fn get(&self, window: &Window) -> Result<Grid> {
        self.grid.crop(window).ok_or_else(|| outside(self.window(), window))
    }

    /// Reads the raster at every point into `out`, between samples as `kind` says; beyond its border it continues with its
    /// border samples, and a point that is not finite reads NaN.
    ///
    /// # Errors
    /// If the disk fails.
    pub fn read(&self, kind: LayerKind, at: &Points, out: &mut [f32]) -> Result<()> {
        resample::read(&self.grid, kind, at, out);
        Ok(())
    }
}

fn outside(raster: &Window, part: &Window) -> Error {
    Error::new(ErrorKind::Request, format!("{part:?} is not part of the raster over {raster:?}"))
}
