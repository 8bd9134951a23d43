//! Bands of whole rows of a large window, for writing files.

use super::tiles::{Tiles, Tiling};
use super::world::World;
use orogen_grid::analysis::finite::FiniteCount;
use orogen_grid::error::{ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;
use orogen_grid::words::count;
use orogen_io::pages::Pages;
use orogen_io::raster::Raster;

/// Approximate number of samples per band.
const SAMPLES: usize = 1 << 23;
/// Minimum and maximum number of rows of a band.
const ROWS: [usize; 2] = [16, 512];

/// Minimum number of rows if memory is short.
const FEWEST: usize = 4;

/// The rows of a large window from the north, in bands: see [`World::bands`].
pub struct Bands<'w> {
    tiles: Tiles<'w>,
    layers: usize,
    window: Window,
    rows: usize,
    /// The first row of the next band.
    next: usize,
    /// The grids over whole rows that were made last, from which the next bands are cut.
    made: Vec<Grid>,
}

impl World {
    /// Makes layers over a window in bands of whole rows, for files larger than memory.
    ///
    /// The bands come from the north, with one grid per layer, and have the bits of the whole window. The work, the
    /// current band and `beside` (bytes that the caller holds) stay within the world's memory limit; otherwise an error
    /// is returned before anything is started.
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
    /// The errors of [`World::tiles`].
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
                Ok(tiles) => {
                    return Ok(Bands { tiles, layers: layers.len(), window: *window, rows, next: 0, made: Vec::new() });
                }
                // Fewer rows need less memory.
                Err(error) if error.kind() == ErrorKind::Memory && rows > FEWEST => rows = rows.div_ceil(2),
                Err(error) if error.kind() == ErrorKind::Memory => {
                    let tile = Window { width: rows.min(window.width), height: rows, ..*window };
                    let tiles = 4 * (layers.len() * tile.len()) as u64;
                    let making = self.memory_of(&self.plan_within(layers, &tile, Some(0))?)?.saturating_add(tiles);
                    let what = format!("making {} at a time", count(rows, "row"));
                    return Err(self.budget().refusal(&what, making.saturating_add(held), "allow more"));
                }
                Err(error) => return Err(error),
            }
        }
    }
}

impl World {
    /// Makes a layer over a window as a raster on disk, within the memory limit, and counts its finite samples. The
    /// file is removed with the raster.
    ///
    /// # Errors
    /// The errors of [`World::bands`], or if the disk is full or fails.
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
        let columns = self.tiles.layout()[0];
        if self.tiles.at_once()[0] == columns {
            return self.cut(&band);
        }
        let mut grids = vec![Grid::filled(band, 0.0); self.layers];
        for _ in 0..columns {
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

impl Bands<'_> {
    /// Cuts a band from grids over whole rows, which need not be cut into tiles.
    fn cut(&mut self, band: &Window) -> Option<Result<Vec<Grid>>> {
        if self.made.is_empty() {
            match self.tiles.next_grids()? {
                Ok(grids) => self.made = grids,
                Err(error) => {
                    self.next = self.window.height;
                    return Some(Err(error));
                }
            }
        }
        let bottom = self.made.first()?.window().bottom();
        let cut = |grid: &Grid| grid.crop(band);
        let grids = match self.made.first()?.window() == band {
            true => std::mem::take(&mut self.made),
            false => self.made.iter().filter_map(cut).collect(),
        };
        if band.bottom() == bottom {
            self.made.clear();
        }
        Some(Ok(grids))
    }
}
