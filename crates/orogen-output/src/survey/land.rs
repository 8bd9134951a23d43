//! The heights that are measured, read in bands of rows from memory or from disk.

use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_io::pages::SIDE;
use orogen_io::raster::Raster;

/// Heights, and the sea level; samples at or below it are not land.
#[derive(Debug, Clone, Copy)]
pub struct Land<'a> {
    heights: Heights<'a>,
    sea_level: Option<f32>,
}

#[derive(Debug, Clone, Copy)]
enum Heights<'a> {
    Memory(&'a Grid),
    Disk(&'a Raster),
}

/// Approximate number of samples of a band of heights in memory.
const SAMPLES: usize = 1 << 19;

/// Bands have a multiple of this number of rows, except the last: a block of this many rows is never in two bands.
pub const ROWS: usize = 32;

impl<'a> Land<'a> {
    /// Heights in memory.
    #[must_use]
    pub fn in_memory(heights: &'a Grid, sea_level: Option<f32>) -> Land<'a> {
        Land { heights: Heights::Memory(heights), sea_level }
    }

    /// Heights on disk.
    pub fn on_disk(heights: &'a Raster, sea_level: Option<f32>) -> Land<'a> {
        Land { heights: Heights::Disk(heights), sea_level }
    }

    /// The window of the heights.
    #[must_use]
    pub fn window(&self) -> &'a Window {
        match self.heights {
            Heights::Memory(grid) => grid.window(),
            Heights::Disk(raster) => raster.window(),
        }
    }

    /// The sea level.
    #[must_use]
    pub fn sea_level(&self) -> Option<f32> {
        self.sea_level
    }

    /// Whether the heights are on disk.
    #[must_use]
    pub fn is_on_disk(&self) -> bool {
        matches!(self.heights, Heights::Disk(_))
    }

    /// Some rows, including the sea bed.
    ///
    /// # Errors
    /// If the disk fails.
    pub fn ground(&self, rows: std::ops::Range<usize>) -> Result<Grid> {
        let whole = *self.window();
        let part = Window { y: whole.y + rows.start as i64, height: rows.len(), ..whole };
        match self.heights {
            Heights::Memory(grid) => Ok(grid.crop(&part).unwrap_or_else(|| Grid::filled(part, f32::NAN))),
            Heights::Disk(raster) => raster.get(&part),
        }
    }

    /// Some rows, with NaN where there is no land.
    ///
    /// # Errors
    /// If the disk fails.
    pub fn rows(&self, rows: std::ops::Range<usize>) -> Result<Grid> {
        let mut land = self.ground(rows)?;
        if let Some(sea) = self.sea_level {
            land.data_mut().iter_mut().filter(|height| **height <= sea).for_each(|height| *height = f32::NAN);
        }
        Ok(land)
    }

    /// Visits all rows that have `halo` rows on both sides, in bands from the north, each with its halo.
    ///
    /// # Errors
    /// If the disk or `visit` fails.
    pub fn bands(&self, halo: usize, mut visit: impl FnMut(&Grid) -> Result<()>) -> Result<()> {
        let (rows, last) = (self.band_rows(), self.window().height.saturating_sub(2 * halo));
        for first in (0..last).step_by(rows) {
            visit(&self.rows(first..(first + rows).min(last) + 2 * halo)?)?;
        }
        Ok(())
    }

    /// Rows of a band without its halo; on disk those of a page, which is read as a whole.
    fn band_rows(&self) -> usize {
        match self.heights {
            Heights::Memory(grid) => (SAMPLES / grid.width().max(1)).next_multiple_of(ROWS).max(ROWS),
            Heights::Disk(_) => SIDE,
        }
    }
}

/// Memory of a band of a window on disk and of the results from it, in bytes.
#[must_use]
pub fn band_memory(window: &Window) -> u64 {
    (window.width as u64).saturating_mul((SIDE + ROWS) as u64 * 4 * 4)
}
