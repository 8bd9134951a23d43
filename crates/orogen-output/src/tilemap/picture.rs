//! Pictures of tiles.

use std::io::{self, Write};

use orogen_io::format::png::{self, Picture, Pixel};

use super::tileset::{Rgba, Tileset, shown};

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

    /// Draws row `y` of the pixels of a row of tiles into a line of pixels of `depth` bytes: every `by`th pixel, or one
    /// pixel for each `by / size` tiles.
    pub fn draw(&self, tiles: &[u32], [by, y]: [usize; 2], line: &mut [u8], depth: usize) {
        // Pixels of the picture per tile, and tiles of the map per pixel of the picture.
        let [side, step] = [(self.size / by).max(1), (by / self.size).max(1)];
        for (tile, place) in tiles.iter().step_by(step).zip(line.chunks_exact_mut(side * depth)) {
            let Some(tile) = shown(*tile) else { continue };
            for (x, pixel) in place.chunks_exact_mut(depth).enumerate() {
                blend(pixel, self.pixel(tile, [x * by, y]));
            }
        }
    }
}

/// Draws a color over a pixel of three or four bytes.
fn blend(pixel: &mut [u8], over: Rgba) {
    let opacity = u32::from(over[3]);
    if opacity == 255 {
        pixel.copy_from_slice(&over[..pixel.len()]);
        return;
    }
    let under = pixel.get(3).map_or(255, |opacity| u32::from(*opacity));
    // The remaining share of the pixel below, and the opacity of both, in units of 1 / 255^2.
    let left = under * (255 - opacity);
    let both = (opacity * 255 + left).max(1);
    for (below, over) in pixel.iter_mut().zip(over).take(3) {
        *below = ((u32::from(over) * opacity * 255 + u32::from(*below) * left + both / 2) / both) as u8;
    }
    if let Some(opacity) = pixel.get_mut(3) {
        *opacity = ((both + 127) / 255) as u8;
    }
}
