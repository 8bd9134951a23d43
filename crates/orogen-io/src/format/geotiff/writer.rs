//! A writer that receives rows and writes a file.

use std::io::{self, Write};

use orogen_grid::parallel;

use super::options::Options;
use super::overview::{Below, Span, half, reduce};
use super::pyramid::Pyramid;
use super::tile::pack;
use crate::spool::Spool;
use orogen_grid::grid::{Grid, Window};

/// Writes a grid. `spool` holds the compressed tiles until their offsets in the file are known.
///
/// ```
/// use orogen_io::format::geotiff::{options::Options, writer};
/// use orogen_io::file::{OutputPolicy, write_whole};
/// use orogen_grid::{Grid, Window};
/// use orogen_io::spool::Spool;
///
/// let grid = Grid::filled(Window::new(600, 400, 30.0), 1200.0);
/// let path = std::env::temp_dir().join(format!("orogen-doc-{}.tif", std::process::id()));
/// let output = OutputPolicy::default().output(&path)?;
/// write_whole(&output, |out| writer::write(out, &grid, &Options::default(), Spool::beside(&path)))?;
/// # std::fs::remove_file(&path).ok();
/// # Ok::<(), orogen_grid::Error>(())
/// ```
pub fn write(out: &mut dyn Write, grid: &Grid, options: &Options, spool: Spool) -> io::Result<()> {
    let mut writer = Writer::new(grid.window(), options, spool)?;
    writer.rows(grid.data())?;
    writer.finish(out)
}

/// Writes a raster: [`Writer::rows`] takes all rows from the top, in any pieces, then [`Writer::finish`] writes the
/// file.
///
/// It keeps one row of tiles per level in memory (two per thread if rows are short). The spool holds the rest: as many
/// bytes as the file will have.
pub struct Writer {
    pyramid: Pyramid,
    levels: Vec<Level>,
    spool: Spool,
}

/// The full raster or an overview.
struct Level {
    width: usize,
    height: usize,
    /// Samples that are still needed, whole rows.
    rows: Vec<f32>,
    /// The first of these rows.
    first: usize,
    /// Number of compressed rows.
    packed: usize,
    /// Number of computed rows of the next level.
    made: usize,
    /// The samples under each column of the next level.
    columns: Vec<Span>,
    /// Position of each compressed tile in the spool, and its length.
    places: Vec<u64>,
    lengths: Vec<u32>,
}

impl Writer {
    /// Starts a file for the samples of `window`.
    ///
    /// Fails if the window has no samples, no valid cell or more than 2^31 - 1 samples per side, or if TIFF or memory
    /// does not allow the tile.
    pub fn new(window: &Window, options: &Options, spool: Spool) -> io::Result<Writer> {
        let pyramid = Pyramid::new(window, options)?;
        let levels = pyramid.sizes().iter().map(|[width, height]| Level::new(*width, *height)).collect();
        Ok(Writer { pyramid, levels, spool })
    }

    /// Takes the next whole rows, each from west to east.
    ///
    /// Fails if the spool fails, or if the samples are not whole rows or exceed the window.
    pub fn rows(&mut self, samples: &[f32]) -> io::Result<()> {
        let full = &self.levels[0];
        if !samples.len().is_multiple_of(full.width) || full.arrived() + samples.len() / full.width > full.height {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, "these are not rows of the raster"));
        }
        // In pieces, so that a whole grid is not in memory twice.
        for piece in samples.chunks(full.width * self.pyramid.tile()) {
            self.take(piece)?;
        }
        Ok(())
    }

    /// Passes rows down the levels; a level continues when it has enough rows.
    fn take(&mut self, samples: &[f32]) -> io::Result<()> {
        self.levels[0].rows.extend_from_slice(samples);
        for k in 0..self.levels.len() {
            let level = &mut self.levels[k];
            let Some(until) = level.ready(self.pyramid.tile()) else {
                return Ok(());
            };
            for bytes in level.pack(self.pyramid.tile(), until) {
                level.places.push(self.spool.push(&bytes)?);
                level.lengths.push(bytes.len() as u32);
            }
            if k + 1 < self.levels.len() {
                let coarser = self.levels[k].reduce(self.pyramid.nodata());
                self.levels[k + 1].rows.extend_from_slice(&coarser);
            }
            self.levels[k].forget();
        }
        Ok(())
    }

    /// Writes the file.
    ///
    /// Fails if `out` or the spool fails, or if rows are missing.
    pub fn finish(mut self, out: &mut dyn Write) -> io::Result<()> {
        if self.levels.iter().any(|level| level.packed < level.height) {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, "rows of the raster are missing"));
        }
        let lengths = self.levels.iter_mut().map(|level| std::mem::take(&mut level.lengths)).collect();
        let Writer { pyramid, levels, mut spool } = self;
        pyramid.write(out, lengths, |level, tile, bytes| spool.read(levels[level].places[tile], bytes))
    }
}

impl Level {
    fn new(width: usize, height: usize) -> Level {
        Level {
            width,
            height,
            rows: Vec::new(),
            first: 0,
            packed: 0,
            made: 0,
            columns: (0..half(width)).map(|i| Span::of(i, width)).collect(),
            places: Vec::new(),
            lengths: Vec::new(),
        }
    }

    /// Number of rows received.
    fn arrived(&self) -> usize {
        self.first + self.rows.len() / self.width
    }

    /// The row up to which rows of tiles can be compressed: enough to occupy the threads, or all after the last row.
    fn ready(&self, tile: usize) -> Option<usize> {
        let arrived = self.arrived();
        if arrived == self.height {
            return Some(self.height);
        }
        let across = self.width.div_ceil(tile);
        let enough = (2 * parallel::threads()).div_ceil(across) * tile;
        let whole = (arrived - self.packed) / tile * tile;
        (whole >= enough).then_some(self.packed + whole)
    }

    /// Compresses the rows of tiles up to row `until`.
    fn pack(&mut self, tile: usize, until: usize) -> Vec<Vec<u8>> {
        let across = self.width.div_ceil(tile);
        let begin = (self.packed - self.first) * self.width;
        let rows = &self.rows[begin..(until - self.first) * self.width];
        let tiles = (until - self.packed).div_ceil(tile) * across;
        let band = tile * self.width;
        let packed = parallel::map(0..tiles, |n| {
            let start = n / across * band;
            pack(&rows[start..rows.len().min(start + band)], self.width, n % across, tile)
        });
        self.packed = until;
        packed
    }

    /// Computes all rows of the next level that can be computed.
    fn reduce(&mut self, missing: Option<f32>) -> Vec<f32> {
        let arrived = self.arrived();
        let more = (self.made..half(self.height)).take_while(|j| Span::of(*j, self.height).end() <= arrived).count();
        let below = Below { rows: &self.rows, left: 0, first: self.first, width: self.width, height: self.height };
        let coarser = reduce(&below, &self.columns, self.made, self.made + more, missing);
        self.made += more;
        coarser
    }

    /// Drops the rows that neither a tile nor the next level needs.
    fn forget(&mut self) {
        let needed = match self.made < half(self.height) {
            true => self.packed.min(Span::of(self.made, self.height).first),
            false => self.packed,
        };
        self.rows.drain(..(needed - self.first) * self.width);
        self.first = needed;
    }
}
