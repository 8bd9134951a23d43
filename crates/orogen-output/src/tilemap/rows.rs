//! Rows of tiles and classes as numbers in files.

use std::fmt::Write as _;

use super::tileset::{Tileset, shown};

/// The flip bits in a cell of Godot.
const FLIP_X: u16 = 1 << 12;
const FLIP_Y: u16 = 1 << 13;
const TRANSPOSE: u16 = 1 << 14;

/// Numbers separated by commas.
#[must_use]
pub fn listed(numbers: &[u32]) -> String {
    let mut text = String::with_capacity(3 * numbers.len());
    for number in numbers {
        let _ = write!(text, "{number},");
    }
    text.pop();
    text
}

/// The cells of a row of a Godot `TileMapLayer`: column, row, source, column and row in the picture, and flips, two
/// bytes each.
#[must_use]
pub fn godot_cells(tileset: &Tileset, tiles: &[u32], row: usize) -> Vec<u8> {
    let bit = |is_set: bool, bit: u16| if is_set { bit } else { 0 };
    let mut cells = Vec::with_capacity(12 * tiles.len());
    for (column, tile) in tiles.iter().enumerate() {
        let Some((picture, flip)) = shown(*tile) else { continue };
        let picture = picture as usize;
        let flips = bit(flip.x, FLIP_X) | bit(flip.y, FLIP_Y) | bit(flip.diagonal, TRANSPOSE);
        let [column, row] = [column, row].map(|at| at as u16);
        let [left, top] = [picture % tileset.columns, picture / tileset.columns].map(|at| at as u16);
        for number in [column, row, 0, left, top, flips] {
            cells.extend(number.to_le_bytes());
        }
    }
    cells
}

/// The `gridTiles` of a row of an LDtk map. A comma precedes each tile except the first of the map.
#[must_use]
pub fn ldtk_tiles(tileset: &Tileset, tiles: &[u32], row: usize, is_first: &mut bool) -> String {
    let (size, columns) = (tileset.size, tileset.columns);
    let mut text = String::new();
    for (column, tile) in tiles.iter().enumerate() {
        let Some((picture, flip)) = shown(*tile) else { continue };
        let [x, y] = [column * size, row * size];
        let [left, top] = [picture as usize % columns * size, picture as usize / columns * size];
        let (flips, place) = (u8::from(flip.x) + 2 * u8::from(flip.y), row * tiles.len() + column);
        let comma = if std::mem::take(is_first) { "" } else { ",\n" };
        let _ = write!(
            text,
            "{comma}{{\"px\":[{x},{y}],\"src\":[{left},{top}],\"f\":{flips},\"t\":{picture},\"d\":[{place}],\"a\":1}}"
        );
    }
    text
}
