//! The picture of a tilemap.

use std::io::{self, Write};
use std::sync::Arc;

use orogen_grid::parallel;
use orogen_io::format::png::{self, Picture, Pixel};
use orogen_io::records::Reader;

use super::map::Tilemap;
use super::tileset::{Fit, Rgba, Tile, Tileset, shown};

/// Maximum side of a picture in pixels.
const MAX_SIDE: usize = 8192;

/// Memory for the tiles of the rows of a picture that are drawn at once, in bytes.
const BAND: usize = 2 << 20;

impl Tilemap {
    /// How many pixels of the map are one of its picture along either side: 1 up to 8192 pixels, and otherwise a divisor or a multiple of the side of a tile.
    #[must_use]
    pub fn reduction(&self) -> usize {
        let size = self.tileset.size;
        let side = self.width.max(self.height);
        // A whole number of pixels for each tile.
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

    /// Writes the picture of the map as a PNG: all pixels of its tiles, or of a large map every [`Tilemap::reduction`]th. It is transparent where nothing is drawn.
    ///
    /// # Errors
    /// If `out` fails.
    pub fn write_png(&self, out: &mut dyn Write, notes: &[(&str, &str)]) -> io::Result<()> {
        let (by, size) = (self.reduction(), self.tileset.size);
        let [width, height] = [self.width, self.height].map(|side| (side * size).div_ceil(by));
        let pixel = if self.is_opaque() { Pixel::Rgb8 } else { Pixel::Rgba8 };
        let picture = Picture::new(width, height, pixel).with_notes(notes);
        let depth = pixel.bytes();
        // Pixels of the picture for each tile, and tiles of the map for each of the picture.
        let [side, step] = [(size / by).max(1), (by / size).max(1)];
        let mut tile_rows = TileRows::new(self);
        png::write(out, &picture, |rows, bytes| {
            bytes.fill(0);
            let mut rows = rows.zip(bytes.chunks_mut(width * depth)).peekable();
            while rows.peek().is_some() {
                // The tiles of as many rows as memory is meant for.
                let (mut lines, mut tiles) = (Vec::new(), Vec::new());
                while let Some((y, line)) = rows.next_if(|_| lines.len() * self.width * 4 * self.layers.len() <= BAND) {
                    lines.push((y * by % size, line));
                    tiles.push(tile_rows.row(y * by / size)?);
                }
                parallel::for_each(lines.into_iter().zip(&tiles), |((y, line), layers)| {
                    for layer in layers.iter() {
                        for (tile, place) in layer.iter().step_by(step).zip(line.chunks_exact_mut(side * depth)) {
                            let Some(tile) = shown(*tile) else { continue };
                            for (x, pixel) in place.chunks_exact_mut(depth).enumerate() {
                                blend(pixel, self.tileset.pixel(tile, [x * by, y]));
                            }
                        }
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

    /// The tiles of a row in each layer that has any; no row before the last one that was asked for.
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

/// Draws a colour over a pixel of three or four bytes.
fn blend(pixel: &mut [u8], over: Rgba) {
    let opacity = u32::from(over[3]);
    if opacity == 255 {
        pixel.copy_from_slice(&over[..pixel.len()]);
        return;
    }
    let under = pixel.get(3).map_or(255, |opacity| u32::from(*opacity));
    // What is left of the pixel below, and the opacity of both, in 255ths of 255ths.
    let left = under * (255 - opacity);
    let both = (opacity * 255 + left).max(1);
    for (below, over) in pixel.iter_mut().zip(over).take(3) {
        *below = ((u32::from(over) * opacity * 255 + u32::from(*below) * left + both / 2) / both) as u8;
    }
    if let Some(opacity) = pixel.get_mut(3) {
        *opacity = ((both + 127) / 255) as u8;
    }
}

impl Tileset {
    /// Writes the picture of the tiles as a PNG with transparency.
    ///
    /// # Errors
    /// If `out` fails.
    pub fn write_png(&self, out: &mut dyn Write, notes: &[(&str, &str)]) -> io::Result<()> {
        let picture = Picture::new(self.width(), self.height(), Pixel::Rgba8).with_notes(notes);
        png::write(out, &picture, |rows, bytes| {
            let pixels = &self.pixels[rows.start * self.width()..rows.end * self.width()];
            bytes.copy_from_slice(pixels.as_flattened());
            Ok(())
        })
    }
}
