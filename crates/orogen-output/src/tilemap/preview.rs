//! The picture of a tilemap.

use std::io::{self, Write};

use orogen_grid::autotile::choose::NONE;
use orogen_io::format::png::{self, Picture, Pixel};
use rayon::prelude::*;

use super::job::Tilemap;
use super::tileset::{Fit, Rgba, Tile, Tileset};

/// Maximum side of a picture in pixels.
const MAX_SIDE: usize = 8192;

impl Tilemap {
    /// How many pixels of the map are one of its picture along either side: 1 up to 8192 pixels.
    #[must_use]
    pub fn reduction(&self) -> usize {
        let size = self.tileset.size;
        let side = self.width.max(self.height) * size;
        // A whole number of pixels for each tile.
        (1..=size).find(|by| size.is_multiple_of(*by) && side / by <= MAX_SIDE).unwrap_or(size)
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
        self.gaps.is_empty() && base.peek().is_some() && base.all(is_opaque)
    }

    /// Writes the picture of the map as a PNG: all pixels of its tiles, or of a large map every [`Tilemap::reduction`]th. It is transparent where nothing is drawn.
    ///
    /// # Errors
    /// If `out` fails.
    pub fn write_png(&self, out: &mut dyn Write, notes: &[(&str, &str)]) -> io::Result<()> {
        let by = self.reduction();
        let side = self.tileset.size / by;
        let pixel = if self.is_opaque() { Pixel::Rgb8 } else { Pixel::Rgba8 };
        let picture = Picture::new(self.width * side, self.height * side, pixel).with_notes(notes);
        let depth = pixel.bytes();
        png::write(out, &picture, |rows, bytes| {
            bytes.fill(0);
            bytes.par_chunks_mut(picture.width * depth).zip(rows.into_par_iter()).for_each(|(line, y)| {
                let tiles = (y / side) * self.width..(y / side + 1) * self.width;
                for layer in &self.layers {
                    for (column, tile) in layer[tiles.clone()].iter().enumerate().filter(|(_, tile)| **tile != NONE) {
                        let place = &mut line[column * side * depth..(column + 1) * side * depth];
                        for (x, pixel) in place.chunks_exact_mut(depth).enumerate() {
                            blend(pixel, self.tileset.pixel(*tile, [x * by, (y % side) * by]));
                        }
                    }
                }
            });
            Ok(())
        })
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
