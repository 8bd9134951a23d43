//! Mosaics of tiles.

use super::layers::{Tiles, Water};
use orogen::{Error, ErrorKind, Result, Window};

/// Tiles along each side of a mosaic.
pub const TILES: usize = 3;

/// 3 x 3 square tiles of `side` cells; the first cell of the first tile is at `origin`.
#[derive(Debug, Clone, Copy)]
pub struct Mosaic {
    /// Distance between samples, in m.
    pub cell: f64,
    /// Column and row of the first cell.
    pub origin: [i64; 2],
    /// Cells along the side of one tile.
    pub side: usize,
}

impl Mosaic {
    /// The window of the whole mosaic.
    pub fn window(&self) -> Window {
        let [x, y] = self.origin;
        Window::new(TILES * self.side, TILES * self.side, self.cell).at(x, y)
    }

    /// Makes every tile and joins them.
    pub fn make(&self, tiles: Tiles) -> Result<Water> {
        let mut whole: Option<Water> = None;
        for part in self.window().tiles(self.side) {
            let tile = tiles(&part)?;
            whole.get_or_insert_with(|| Water::like(&tile, self.window())).paste(&tile);
        }
        whole.ok_or_else(|| Error::new(ErrorKind::Request, "a mosaic needs at least one tile"))
    }
}
