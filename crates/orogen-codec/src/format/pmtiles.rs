//! The directories of PMTiles (version 3): which tile is where in the file.

use std::collections::HashMap;
use std::io::{self, Write};

use super::gzip;
use super::mvt::append_varint;

/// Maximum length of the root directory, in bytes: readers request the header and it at once.
pub const MAX_ROOT: usize = 16_384 - 127;

/// Entries of a leaf directory, if the root alone does not suffice.
const LEAF: usize = 4096;

/// Some tiles in a row with the same content, or a leaf directory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Entry {
    /// The number of the first tile.
    pub tile: u64,
    /// The first byte of the content, from the first one of all tiles or leaves.
    pub offset: u64,
    /// The length of the content, in bytes.
    pub length: u32,
    /// The number of tiles; 0 for a leaf directory.
    pub run: u32,
}

/// The number of a tile: zooms in order, each along a Hilbert curve.
#[must_use]
pub fn tile_number(zoom: u32, column: u64, row: u64) -> u64 {
    let (mut x, mut y, mut number) = (column, row, 0);
    for bit in (0..zoom).rev() {
        let side = 1 << bit;
        let [right, down] = [u64::from(x & side != 0), u64::from(y & side != 0)];
        number += side * side * ((3 * right) ^ down);
        if down == 0 {
            if right == 1 {
                x = side.wrapping_sub(1).wrapping_sub(x) & (side - 1);
                y = side.wrapping_sub(1).wrapping_sub(y) & (side - 1);
            }
            (x, y) = (y, x);
        }
        (x, y) = (x & (side - 1), y & (side - 1));
    }
    // The tiles of all zooms before.
    ((1 << (2 * zoom)) - 1) / 3 + number
}

/// The tiles of an archive, in the order of their numbers, with each content stored once.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TileIndex {
    /// The entries, in order.
    pub entries: Vec<Entry>,
    /// The positions, in the given list, of the tiles whose contents are stored, in the order of the file.
    pub stored: Vec<usize>,
    /// Bytes of all contents.
    pub bytes: u64,
    /// Number of tiles.
    pub tiles: u64,
}

impl TileIndex {
    /// The index of tiles given by number, length and a hash of their content.
    #[must_use]
    pub fn of<K: std::hash::Hash + Eq>(tiles: &[(u64, u32, K)]) -> TileIndex {
        let mut order: Vec<usize> = (0..tiles.len()).collect();
        order.sort_unstable_by_key(|k| tiles[*k].0);
        let mut index = TileIndex { tiles: tiles.len() as u64, ..TileIndex::default() };
        let mut known: HashMap<&K, u64> = HashMap::new();
        for k in order {
            let (tile, length, content) = &tiles[k];
            let offset = *known.entry(content).or_insert_with(|| {
                index.stored.push(k);
                index.bytes += u64::from(*length);
                index.bytes - u64::from(*length)
            });
            match index.entries.last_mut() {
                Some(last) if last.offset == offset && last.tile + u64::from(last.run) == *tile => last.run += 1,
                _ => index.entries.push(Entry { tile: *tile, offset, length: *length, run: 1 }),
            }
        }
        index
    }

    /// The root directory and the leaf directories one after the other, compressed.
    ///
    /// # Errors
    /// If they cannot be compressed.
    pub fn directories(&self) -> io::Result<(Vec<u8>, Vec<u8>)> {
        let mut root = packed(&self.entries)?;
        let (mut leaves, mut size) = (Vec::new(), LEAF);
        while root.len() > MAX_ROOT {
            leaves.clear();
            let mut entries = Vec::new();
            for part in self.entries.chunks(size) {
                let leaf = packed(part)?;
                let (offset, length) = (leaves.len() as u64, leaf.len() as u32);
                entries.extend(part.first().map(|first| Entry { tile: first.tile, offset, length, run: 0 }));
                leaves.extend(leaf);
            }
            root = packed(&entries)?;
            size *= 2;
        }
        Ok((root, leaves))
    }
}

/// A directory, compressed.
fn packed(entries: &[Entry]) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    append_varint(&mut bytes, entries.len() as u64);
    let mut last = 0;
    for entry in entries {
        append_varint(&mut bytes, entry.tile - last);
        last = entry.tile;
    }
    entries.iter().for_each(|entry| append_varint(&mut bytes, u64::from(entry.run)));
    entries.iter().for_each(|entry| append_varint(&mut bytes, u64::from(entry.length)));
    let mut next = None;
    for entry in entries {
        // 0 stands for the byte after the content of the entry before.
        append_varint(&mut bytes, if next == Some(entry.offset) { 0 } else { entry.offset + 1 });
        next = Some(entry.offset + u64::from(entry.length));
    }
    compressed(&bytes)
}

/// Bytes compressed with gzip.
///
/// # Errors
/// If they cannot be compressed.
pub fn compressed(bytes: &[u8]) -> io::Result<Vec<u8>> {
    let mut packed = Vec::new();
    let mut gzip = gzip::start(&mut packed)?;
    gzip.write_all(bytes)?;
    gzip::finish(gzip)?;
    Ok(packed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_are_numbered_along_hilbert_curves() {
        // The examples of the specification.
        for (zoom, column, row, expect) in [
            (0, 0, 0, 0),
            (1, 0, 0, 1),
            (1, 0, 1, 2),
            (1, 1, 1, 3),
            (1, 1, 0, 4),
            (2, 0, 0, 5),
            (12, 3423, 1763, 19_078_479),
        ] {
            assert_eq!(tile_number(zoom, column, row), expect, "{zoom}/{column}/{row}");
        }
        // A curve through all tiles of a zoom, from neighbor to neighbor.
        for zoom in 1..6 {
            let side = 1u64 << zoom;
            let mut all: Vec<(u64, u64, u64)> =
                (0..side * side).map(|k| (tile_number(zoom, k % side, k / side), k % side, k / side)).collect();
            all.sort_unstable();
            let first = (side * side - 1) / 3;
            for (k, pair) in all.windows(2).enumerate() {
                assert_eq!(pair[0].0, first + k as u64);
                assert_eq!(pair[0].1.abs_diff(pair[1].1) + pair[0].2.abs_diff(pair[1].2), 1);
            }
        }
        assert_eq!(tile_number(31, 0, 0), ((1u64 << 62) - 1) / 3);
    }

    #[test]
    fn contents_are_stored_once_and_runs_are_one_entry() {
        let tiles = [(9, 4, "d"), (5, 7, "sea"), (6, 7, "sea"), (7, 7, "sea"), (8, 2, "c"), (11, 7, "sea")];
        let index = TileIndex::of(&tiles);
        let entry = |tile, offset, length, run| Entry { tile, offset, length, run };
        assert_eq!(index.entries, [entry(5, 0, 7, 3), entry(8, 7, 2, 1), entry(9, 9, 4, 1), entry(11, 0, 7, 1)]);
        assert_eq!((index.stored, index.bytes, index.tiles), (vec![1, 4, 0], 13, 6));
    }

    #[test]
    fn many_tiles_have_leaves() {
        let few: Vec<(u64, u32, u64)> = (0..100).map(|k| (k, 100, k)).collect();
        assert!(TileIndex::of(&few).directories().unwrap().1.is_empty());
        // Lengths that do not compress.
        let many: Vec<(u64, u32, u64)> =
            (0..60_000u64).map(|k| (k * 3, (k.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 48) as u32 + 1, k)).collect();
        let (root, leaves) = TileIndex::of(&many).directories().unwrap();
        assert!(root.len() <= MAX_ROOT && leaves.len() > MAX_ROOT);
        // A leaf is a directory of its own: the header of gzip is at its start.
        assert_eq!(leaves[..3], [0x1f, 0x8b, 8]);
    }
}
