//! The picture of a tileset.

use std::io::Cursor;
use std::path::Path;

use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_io::open;

use crate::tilemap::tileset::{MAX_TILES, Rgba};

/// Maximum size of a picture file, in bytes.
const MAX_FILE: u64 = 64 << 20;

/// Maximum number of pixels of a picture.
const MAX_PIXELS: usize = 1 << 26;

/// The positions of the tiles in a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Grid {
    /// Width and height of a tile, in pixels.
    pub size: usize,
    /// Pixels around all tiles.
    pub margin: usize,
    /// Pixels between tiles.
    pub spacing: usize,
    /// A color that is transparent.
    pub transparent: Option<[u8; 3]>,
}

/// Tiles cut out of a picture.
pub(super) struct Cut {
    pub count: usize,
    pub columns: usize,
    /// The pixels without margin and spacing, row-major.
    pub pixels: Vec<Rgba>,
}

/// Cuts the PNG at a path into tiles.
pub(super) fn cut(path: &Path, grid: &Grid) -> Result<Cut> {
    let failed = |why: String| Error::new(ErrorKind::File, format!("cannot use {} as tiles: {why}", path.display()));
    let bytes = open::bytes(path, "read the picture of the tiles", MAX_FILE)?
        .ok_or_else(|| failed(format!("it is larger than {} MB", MAX_FILE >> 20)))?;
    let unread = |cause: png::DecodingError| failed(format!("it is no readable PNG ({cause}); save it as PNG"));
    let mut decoder = png::Decoder::new(Cursor::new(&bytes));
    decoder.set_transformations(
        png::Transformations::EXPAND | png::Transformations::STRIP_16 | png::Transformations::ALPHA,
    );
    let header = decoder.read_header_info().map_err(unread)?;
    let [width, height] = [header.width, header.height].map(|side| side as usize);
    if width.saturating_mul(height) > MAX_PIXELS {
        return Err(failed(format!(
            "its {width} x {height} pixels are more than {MAX_PIXELS}; cut it into smaller sets"
        )));
    }
    let mut reader = decoder.read_info().map_err(unread)?;
    let mut data = vec![0; reader.output_buffer_size().unwrap_or_default()];
    let info = reader.next_frame(&mut data).map_err(unread)?;
    let pixels: Vec<Rgba> = match info.color_type {
        png::ColorType::GrayscaleAlpha => {
            data.as_chunks::<2>().0.iter().map(|[grey, a]| [*grey, *grey, *grey, *a]).collect()
        }
        _ => data.as_chunks::<4>().0.to_vec(),
    };
    let tiles = |side: usize| (side + grid.spacing).saturating_sub(2 * grid.margin) / (grid.size + grid.spacing);
    let [columns, rows] = [tiles(width), tiles(height)];
    if columns == 0 || rows == 0 || columns * rows >= MAX_TILES {
        return Err(failed(format!(
            "its {width} x {height} pixels hold no tile of {size} x {size} pixels with a margin of {} and a spacing of {}",
            grid.margin,
            grid.spacing,
            size = grid.size
        )));
    }
    let at = |x: usize, y: usize| {
        let place = |at: usize| grid.margin + at / grid.size * (grid.size + grid.spacing) + at % grid.size;
        let pixel = pixels[place(y) * width + place(x)];
        let [red, green, blue, _] = pixel;
        if grid.transparent == Some([red, green, blue]) { [0; 4] } else { pixel }
    };
    let pixels = (0..rows * grid.size).flat_map(|y| (0..columns * grid.size).map(move |x| (x, y)));
    Ok(Cut { count: columns * rows, columns, pixels: pixels.map(|(x, y)| at(x, y)).collect() })
}

/// A color as #rrggbb, with or without the #.
pub(super) fn color(text: &str) -> Option<[u8; 3]> {
    let digits = text.strip_prefix('#').unwrap_or(text);
    // Tiled writes the opacity first, if there is one.
    let digits = if digits.len() == 8 { digits.get(2..)? } else { digits };
    orogen_grid::hex::decode(digits)
}
