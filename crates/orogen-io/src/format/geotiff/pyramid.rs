//! The levels of a raster and their tiles.

use std::io::{self, Write};

use super::directory::{self, Description, Level};
use super::options::Options;
use super::overview::half;

use orogen_grid::grid::Window;

/// The levels of a raster, from the full one to the coarsest, split into tiles.
#[derive(Debug)]
pub struct Pyramid {
    description: Description,
    big: bool,
    sizes: Vec<[usize; 2]>,
}

impl Pyramid {
    /// The pyramid of the samples of `window`.
    ///
    /// Fails if the window has no samples, no valid cell or more than 2^31 - 1 samples per side, or if TIFF or memory
    /// does not allow the tile.
    pub fn new(window: &Window, options: &Options) -> io::Result<Pyramid> {
        let refuse = |why: String| Err(io::Error::new(io::ErrorKind::InvalidInput, why));
        let tile = options.tile.unwrap_or_else(|| usual_tile(window));
        if let Some(side) =
            [window.width, window.height].into_iter().find(|side| !(1..=i32::MAX as usize).contains(side))
        {
            return refuse(format!("a GeoTIFF has 1 to 2147483647 samples a side, not {side}"));
        }
        if !(window.cell.is_finite() && window.cell > 0.0) {
            return refuse(format!("a GeoTIFF cannot have cells of {} m", window.cell));
        }
        if !(16..=8192).contains(&tile) || !tile.is_multiple_of(16) {
            return refuse(format!(
                "the tiles of a GeoTIFF must have 16 to 8192 samples per side, a multiple of 16, not {tile}"
            ));
        }
        let Options { nodata, unit, map, .. } = options.clone();
        let description = Description { window: *window, tile, nodata, unit, map };
        Ok(Pyramid { description, big: options.big, sizes: sizes(window, tile).collect() })
    }

    /// Side of a tile, in samples.
    #[must_use]
    pub fn tile(&self) -> usize {
        self.description.tile
    }

    /// The nodata value.
    #[must_use]
    pub fn nodata(&self) -> Option<f32> {
        self.description.nodata
    }

    /// Width and height of each level.
    #[must_use]
    pub fn sizes(&self) -> &[[usize; 2]] {
        &self.sizes
    }

    /// Number of tiles of a level, across and down.
    #[must_use]
    pub fn tiles(&self, level: usize) -> [usize; 2] {
        self.sizes[level].map(|side| side.div_ceil(self.tile()))
    }

    /// Writes the file. `lengths` are the sizes of the compressed tiles, level by level and row by row. `read` receives
    /// a level and a tile's number, and fills a buffer with that tile.
    ///
    /// Fails if `out` or `read` fails.
    pub fn write(
        &self,
        out: &mut dyn Write,
        lengths: Vec<Vec<u32>>,
        mut read: impl FnMut(usize, usize, &mut Vec<u8>) -> io::Result<()>,
    ) -> io::Result<()> {
        let table: Vec<Level> = (self.sizes.iter().zip(lengths))
            .map(|([width, height], lengths)| Level { width: *width, height: *height, lengths })
            .collect();
        out.write_all(&directory::head(&self.description, &table, self.big))?;
        for (level, table) in table.iter().enumerate().rev() {
            for (tile, length) in table.lengths.iter().enumerate() {
                let mut bytes = vec![0; *length as usize];
                read(level, tile, &mut bytes)?;
                out.write_all(&length.to_le_bytes())?;
                out.write_all(&bytes)?;
                out.write_all(&bytes[bytes.len() - directory::TRAILER as usize..])?;
            }
        }
        Ok(())
    }
}

/// The size of each level, from the full raster to the one that fits a tile.
fn sizes(window: &Window, tile: usize) -> impl Iterator<Item = [usize; 2]> {
    std::iter::successors(Some([window.width, window.height]), move |size| {
        size.iter().any(|side| *side > tile).then(|| size.map(half))
    })
}

/// The default tile: 512, or 384 if a level is 512 wide. No raster has levels of both widths.
fn usual_tile(window: &Window) -> usize {
    match sizes(window, 512).any(|[width, height]| width == 512 && height > 512) {
        true => 384,
        false => 512,
    }
}
