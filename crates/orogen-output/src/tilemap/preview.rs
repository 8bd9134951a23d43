//! The picture of a tilemap.

use std::io::{self, Write};

use orogen_grid::autotile::choose::NONE;
use orogen_io::format::png::{self, Picture, Pixel};
use rayon::prelude::*;

use super::job::Tilemap;
use super::tileset::Tileset;

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

    /// Writes the picture of the map as a PNG: all pixels of its tiles, or of a large map every [`Tilemap::reduction`]th.
    ///
    /// # Errors
    /// If `out` fails.
    pub fn write_png(&self, out: &mut dyn Write, notes: &[(&str, &str)]) -> io::Result<()> {
        let by = self.reduction();
        let side = self.tileset.size / by;
        let picture = Picture::new(self.width * side, self.height * side, Pixel::Rgb8).with_notes(notes);
        png::write(out, &picture, |rows, bytes| {
            bytes.par_chunks_mut(picture.width * 3).zip(rows.into_par_iter()).for_each(|(line, y)| {
                let tiles = (y / side) * self.width..(y / side + 1) * self.width;
                for layer in &self.layers {
                    for (column, tile) in layer[tiles.clone()].iter().enumerate().filter(|(_, tile)| **tile != NONE) {
                        let row = self.tileset.row(*tile as usize, (y % side) * by);
                        let place = &mut line[column * side * 3..(column + 1) * side * 3];
                        for (pixel, [red, green, blue, opacity]) in
                            place.chunks_exact_mut(3).zip(row.iter().step_by(by))
                        {
                            if *opacity > 0 {
                                pixel.copy_from_slice(&[*red, *green, *blue]);
                            }
                        }
                    }
                }
            });
            Ok(())
        })
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
