//! A big window as bands of whole rows, as most files are written.

use crate::tiles::{Tiles, Tiling};
use crate::world::World;
use orogen_grid::analysis::finite::FiniteCount;
use orogen_grid::error::{ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;
use orogen_grid::words::count;
use orogen_io::pages::Pages;
use orogen_io::raster::Raster;

/// About how many samples a band has, and the fewest and most rows.
const SAMPLES: usize = 1 << 23;
const ROWS: [usize; 2] = [16, 512];

/// The fewest rows where memory is short.
const FEWEST: usize = 4;

/// The rows of a big window from the north, some at a time: see [`World::bands`].
pub struct Bands<'w> {
    tiles: Tiles<'w>,
    layers: usize,
    window: Window,
    rows: usize,
    /// The row that the next band begins with.
    next: usize,
}

impl World {
    /// Makes layers over a window in bands of whole rows, in little memory: for files larger than it.
    ///
    /// The bands come from the north, one grid a layer, and have the bits of the whole window. Making them, the band at hand and `beside` (bytes
    /// that the caller holds meanwhile) stay within the world's memory limit; what cannot is refused before anything is started.
    ///
    /// ```
    /// use orogen_engine::{Progress, Window, World};
    ///
    /// let world = World::open(orogen_engine::presets::find("hills").ok_or("no such preset")?.recipe()?)?;
    /// let window = Window::new(500, 700, 20.0);
    /// let mut heights = Vec::new();
    /// for band in world.bands(&["height"], &window, 0, &Progress::none())? {
    ///     heights.extend_from_slice(band?[0].data());
    /// }
    /// assert_eq!(heights, world.window("height", &window)?.data());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`World::tiles`].
    pub fn bands<'w>(
        &'w self,
        layers: &[&str],
        window: &Window,
        reserved: u64,
        progress: &Progress,
    ) -> Result<Bands<'w>> {
        let mut rows = (SAMPLES / window.width.max(1)).clamp(ROWS[0], ROWS[1]).min(window.height.max(1));
        loop {
            let band = (window.width as u64).saturating_mul(rows as u64).saturating_mul(4 * layers.len() as u64);
            let held = reserved.saturating_add(band);
            let memory = self.memory_limit().map(|limit| limit.saturating_sub(held));
            match self.tiles(layers, window, Tiling { memory, ..Tiling::of(rows) }, progress) {
                Ok(tiles) => return Ok(Bands { tiles, layers: layers.len(), window: *window, rows, next: 0 }),
                // Fewer rows take less.
                Err(error) if error.kind() == ErrorKind::Memory && rows > FEWEST => rows = rows.div_ceil(2),
                Err(error) if error.kind() == ErrorKind::Memory => {
                    let tile = Window { width: rows.min(window.width), height: rows, ..*window };
                    let tiles = 4 * (layers.len() * tile.len()) as u64;
                    let making = self.memory_of(&self.plan(layers, &tile)?).saturating_add(tiles);
                    let what = format!("making {} at a time", count(rows, "row"));
                    return Err(self.budget().refusal(&what, making.saturating_add(held), "allow more"));
                }
                Err(error) => return Err(error),
            }
        }
    }
}

impl World {
    /// Makes a layer over a window as a raster on disk, in little memory, and counts its finite samples. The file is gone with the raster.
    ///
    /// # Errors
    /// As [`World::bands`], or if the disk takes no more.
    pub fn raster(&self, layer: &str, window: &Window, progress: &Progress) -> Result<(Raster, FiniteCount)> {
        let mut raster = Raster::on_disk(Pages::scratch(self.scratch(), *window)?);
        let mut count = FiniteCount::default();
        for band in self.bands(&[layer], window, 0, progress)? {
            for grid in band? {
                count = count.and(FiniteCount::of(grid.data()));
                raster.put(&grid)?;
            }
        }
        Ok((raster, count))
    }
}

impl Iterator for Bands<'_> {
    type Item = Result<Vec<Grid>>;

    fn next(&mut self) -> Option<Result<Vec<Grid>>> {
        if self.next >= self.window.height {
            return None;
        }
        let height = self.rows.min(self.window.height - self.next);
        let band = Window { y: self.window.y + self.next as i64, height, ..self.window };
        self.next += height;
        let mut grids = vec![Grid::filled(band, 0.0); self.layers];
        for _ in 0..self.tiles.layout()[0] {
            match self.tiles.next()? {
                Ok(tile) => grids.iter_mut().zip(&tile.grids).for_each(|(grid, tile)| grid.paste(tile)),
                Err(error) => {
                    self.next = self.window.height;
                    return Some(Err(error));
                }
            }
        }
        Some(Ok(grids))
    }
}
