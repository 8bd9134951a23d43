//! The picture of a tilemap.

use std::io::{self, Write};
use std::sync::Arc;

use orogen_grid::parallel;
use orogen_io::format::png::{self, Picture, Pixel};
use orogen_io::records::Reader;

use super::map::Tilemap;
use super::tileset::{Fit, Tile};

/// Maximum side of a picture in pixels.
const MAX_SIDE: usize = 8192;

/// Memory, in bytes, for the tiles of the rows that are drawn at once.
const BAND: usize = 2 << 20;

impl Tilemap {
    /// Number of pixels of the map per pixel of its picture along each side: 1 up to 8192 pixels, otherwise a divisor
    /// or a multiple of the side of a tile.
    #[must_use]
    pub fn reduction(&self) -> usize {
        let size = self.tileset.size;
        let side = self.width.max(self.height);
        // A whole number of pixels per tile.
        let within = (1..=size).find(|by| size.is_multiple_of(*by) && side * (size / by) <= MAX_SIDE);
        within.unwrap_or_else(|| size * side.div_ceil(MAX_SIDE))
    }

    /// Whether every pixel of the map is opaque.
    fn is_opaque(&self) -> bool {
        let mut base = self
            .tileset
            .tiles
            .iter()
            .filter(|tile| matches!(tile.fit, Fit::Wang(_) | Fit::Layer { class: 0, .. }))
            .peekable();
        let is_opaque = |tile: &Tile| {
            let mut pixels = (0..self.tileset.size).flat_map(|y| self.tileset.row(tile.picture as usize, y));
            pixels.all(|pixel| pixel[3] == 255)
        };
        self.gap_count == 0 && base.peek().is_some() && base.all(is_opaque)
    }

    /// Writes the picture of the map as a PNG: all pixels of its tiles, or of a large map every
    /// [`Tilemap::reduction`]th. It is transparent where there are no tiles.
    ///
    /// # Errors
    /// If `out` fails.
    pub fn write_png(&self, out: &mut dyn Write, notes: &[(&str, &str)]) -> io::Result<()> {
        let (by, size) = (self.reduction(), self.tileset.size);
        let [width, height] = [self.width, self.height].map(|side| (side * size).div_ceil(by));
        let pixel = if self.is_opaque() { Pixel::Rgb8 } else { Pixel::Rgba8 };
        let picture = Picture::new(width, height, pixel).with_notes(notes);
        let depth = pixel.bytes();
        let mut tile_rows = TileRows::new(self);
        png::write(out, &picture, |rows, bytes| {
            bytes.fill(0);
            let mut rows = rows.zip(bytes.chunks_mut(width * depth)).peekable();
            while rows.peek().is_some() {
                // The tiles of as many rows as fit in the memory for them.
                let (mut lines, mut tiles) = (Vec::new(), Vec::new());
                while let Some((y, line)) = rows.next_if(|_| lines.len() * self.width * 4 * self.layers.len() <= BAND) {
                    lines.push((y * by % size, line));
                    tiles.push(tile_rows.row(y * by / size)?);
                }
                parallel::for_each(lines.into_iter().zip(&tiles), |((y, line), layers)| {
                    for layer in layers.iter() {
                        self.tileset.draw(layer, [by, y], line, depth);
                    }
                });
            }
            Ok(())
        })
    }
}

/// Rows of tiles of all layers, from the first to the last.
struct TileRows<'m> {
    map: &'m Tilemap,
    readers: Vec<Reader<'m, u32>>,
    /// The last row that was read, and the next one.
    row: Arc<Vec<Vec<u32>>>,
    next: usize,
}

impl<'m> TileRows<'m> {
    fn new(map: &'m Tilemap) -> TileRows<'m> {
        let used = map.layers.iter().filter(|layer| layer.is_used);
        TileRows { map, readers: used.map(|layer| layer.tiles.reader()).collect(), row: Arc::default(), next: 0 }
    }

    /// The tiles of a row in each non-empty layer. Rows must be requested in order.
    fn row(&mut self, row: usize) -> io::Result<Arc<Vec<Vec<u32>>>> {
        if row >= self.next {
            let skipped = ((row - self.next) * self.map.width) as u64;
            self.next = row + 1;
            let layers = parallel::try_map(&mut self.readers, |reader| -> io::Result<Vec<u32>> {
                let mut tiles = Vec::new();
                reader.skip(skipped)?;
                reader.read(self.map.width, &mut tiles)?;
                Ok(tiles)
            })?;
            self.row = Arc::new(layers);
        }
        Ok(self.row.clone())
    }
}
