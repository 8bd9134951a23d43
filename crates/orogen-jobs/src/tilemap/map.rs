//! A map of tiles.

use std::io;

use orogen_grid::analysis::finite::FiniteCount;
use orogen_grid::autotile::drawable::Gap;
use orogen_grid::autotile::mask::Layout;
use orogen_grid::grid::Window;
use orogen_io::records::{Record, Records};

use super::tileset::Tileset;

/// A layer of tiles.
#[derive(Debug)]
#[non_exhaustive]
pub struct TileLayer {
    /// The tiles, row-major, as stored in map files: 0 for no tile, otherwise 1 more than the
    /// [number](super::tileset::number) of the tile.
    pub tiles: Records<u32>,
    /// Whether the layer has any tile.
    pub is_used: bool,
    /// Whether any tile is rotated by a quarter turn.
    pub is_turned: bool,
}

/// A map of tiles.
#[derive(Debug)]
#[non_exhaustive]
pub struct Tilemap {
    /// The tileset.
    pub tileset: Tileset,
    /// The window of the map's cells, with one class per cell. The cell is in metres.
    pub window: Window,
    /// The class of each cell, row-major; in a corner layout, the class at each corner of a tile.
    pub classes: Records<u8>,
    /// Number of cells of each class of the tileset.
    pub class_counts: Vec<u64>,
    /// Tiles per row.
    pub width: usize,
    /// Rows of tiles.
    pub height: usize,
    /// One layer for each class, bottom to top, or a single one for a wang tileset.
    pub layers: Vec<TileLayer>,
    /// Number of positions without a tile before the clean-up.
    pub gaps_before: u64,
    /// Number of positions without a tile in the map.
    pub gap_count: u64,
    /// The first positions without a tile, at most 1000.
    pub gaps: Vec<Gap>,
    /// Number of cells whose class the clean-up changed.
    pub changed: u64,
    /// The count of finite samples among the classes that the map was made from. Cells without a class have the first
    /// one.
    pub finite: FiniteCount,
    /// The names of the kinds of scattered objects.
    pub kinds: Vec<String>,
    /// The scattered objects on the map, from back to front.
    pub objects: Records<MapObject>,
    /// Whether Tiled maps are infinite.
    pub is_infinite: bool,
    /// The seed for choosing variants of tiles: the world's seed.
    pub seed: u64,
}

impl Tilemap {
    /// Cells per row of [`Tilemap::classes`].
    #[must_use]
    pub fn class_columns(&self) -> usize {
        self.window.width + usize::from(self.tileset.layout == Layout::Corner)
    }

    /// Calls `of_object` with each object and its number, from 0.
    pub(super) fn each_object(&self, mut of_object: impl FnMut(u64, MapObject) -> io::Result<()>) -> io::Result<()> {
        let (mut reader, mut objects, mut nth) = (self.objects.reader(), Vec::new(), 0);
        loop {
            reader.read(1024, &mut objects)?;
            if objects.is_empty() {
                return Ok(());
            }
            for object in objects.drain(..) {
                of_object(nth, object)?;
                nth += 1;
            }
        }
    }
}

/// A scattered object on a map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapObject {
    /// The kind: an index of [`Tilemap::kinds`].
    pub kind: usize,
    /// The position, in tiles from the left and upper side of the map.
    pub position: [f64; 2],
    /// Scale factor.
    pub size: f64,
    /// Rotation in degrees, clockwise.
    pub turn: f64,
}

impl Record for MapObject {
    const BYTES: usize = 40;

    fn put(self, bytes: &mut [u8]) {
        let [x, y] = self.position;
        let numbers = [self.kind as u64, x.to_bits(), y.to_bits(), self.size.to_bits(), self.turn.to_bits()];
        bytes.chunks_exact_mut(8).zip(numbers).for_each(|(bytes, number)| bytes.copy_from_slice(&number.to_le_bytes()));
    }

    fn get(bytes: &[u8]) -> MapObject {
        let number = |at: usize| {
            let bytes = bytes.get(8 * at..8 * at + 8).and_then(|bytes| bytes.try_into().ok());
            bytes.map(u64::from_le_bytes).unwrap_or_default()
        };
        let [x, y, size, turn] = [1, 2, 3, 4].map(|at| f64::from_bits(number(at)));
        MapObject { kind: number(0) as usize, position: [x, y], size, turn }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_object_is_the_one_of_its_bytes() {
        let object = MapObject { kind: 3, position: [0.1, -7.5], size: 1.25, turn: 359.0 };
        let mut bytes = [0; MapObject::BYTES];
        object.put(&mut bytes);
        assert_eq!(MapObject::get(&bytes), object);
    }
}
