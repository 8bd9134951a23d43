//! PMTiles (version 3): all tiles of a map in one file, which programs read by HTTP ranges.
//!
//! Tiles are in the order of their numbers ("clustered"), each content is stored once, and adjacent tiles with the same
//! content are one entry of the directory.

use std::io::{self, Write};

use orogen_codec::format::pmtiles::{TileIndex, compressed, tile_number};

/// What tiles are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TileKind {
    /// Vector tiles.
    Mvt,
    /// PNG pictures.
    Png,
}

/// The description of an archive.
#[derive(Debug, Clone, PartialEq)]
pub struct Archive {
    /// What its tiles are.
    pub kind: TileKind,
    /// The lowest and the highest zoom.
    pub zooms: [u32; 2],
    /// West, south, east and north, in degrees.
    pub bounds: [f64; 4],
    /// The zoom that a map shows first, in the middle of the bounds.
    pub shown: u32,
    /// The metadata, as JSON.
    pub metadata: String,
}

/// A tile: zoom, column and row, the length of its content in bytes, and a hash of the content.
pub type ArchiveTile<'a> = ([u64; 3], u32, &'a str);

/// Bytes of the header.
const HEADER: u64 = 127;

/// Codes of compression.
const NONE: u8 = 1;
const GZIP: u8 = 2;

impl Archive {
    /// Writes the file. `read` puts the content of a tile, by its index, into a buffer.
    ///
    /// # Errors
    /// If `out` or `read` fails, or a tile has another length than given.
    pub fn write(
        &self,
        out: &mut dyn Write,
        tiles: &[ArchiveTile],
        mut read: impl FnMut(usize, &mut Vec<u8>) -> io::Result<()>,
    ) -> io::Result<()> {
        let numbered: Vec<(u64, u32, &str)> = (tiles.iter())
            .map(|([zoom, column, row], length, hash)| (tile_number(*zoom as u32, *column, *row), *length, *hash))
            .collect();
        let index = TileIndex::of(&numbered);
        let (root, leaves) = index.directories()?;
        let metadata = compressed(self.metadata.as_bytes())?;
        let parts = [root.len() as u64, metadata.len() as u64, leaves.len() as u64, index.bytes];
        out.write_all(&self.header(parts, &index))?;
        out.write_all(&root)?;
        out.write_all(&metadata)?;
        out.write_all(&leaves)?;
        let mut bytes = Vec::new();
        for k in index.stored {
            read(k, &mut bytes)?;
            if bytes.len() != tiles[k].1 as usize {
                let [zoom, column, row] = tiles[k].0;
                let message = format!("the tile {zoom}/{column}/{row} has changed since it was made");
                return Err(io::Error::new(io::ErrorKind::InvalidData, message));
            }
            out.write_all(&bytes)?;
        }
        Ok(())
    }

    /// The header, with the lengths of the root directory, the metadata, the leaf directories and the tiles.
    fn header(&self, parts: [u64; 4], index: &TileIndex) -> Vec<u8> {
        let mut bytes = b"PMTiles\x03".to_vec();
        let mut offset = HEADER;
        for length in parts {
            bytes.extend(offset.to_le_bytes());
            bytes.extend(length.to_le_bytes());
            offset += length;
        }
        for count in [index.tiles, index.entries.len() as u64, index.stored.len() as u64] {
            bytes.extend(count.to_le_bytes());
        }
        // Vector tiles are compressed one by one; pictures are already.
        let (kind, packed) = match self.kind {
            TileKind::Mvt => (1, GZIP),
            TileKind::Png => (2, NONE),
        };
        bytes.extend([1, GZIP, packed, kind, self.zooms[0] as u8, self.zooms[1] as u8]);
        let degrees = |value: f64| ((value * 1e7).round() as i32).to_le_bytes();
        let [west, south, east, north] = self.bounds;
        bytes.extend([west, south, east, north].into_iter().flat_map(degrees));
        bytes.push(self.shown as u8);
        bytes.extend([(west + east) / 2.0, (south + north) / 2.0].into_iter().flat_map(degrees));
        bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_header_says_where_everything_is() {
        let archive = Archive {
            kind: TileKind::Png,
            zooms: [0, 1],
            bounds: [-10.0, -20.5, 30.0, 40.25],
            shown: 1,
            metadata: "{\"a\":1}".into(),
        };
        let contents = ["top", "sea", "sea", "land", "sea"];
        let tiles: Vec<ArchiveTile> = [[0, 0, 0], [1, 0, 0], [1, 0, 1], [1, 1, 0], [1, 1, 1]]
            .into_iter()
            .zip(contents)
            .map(|(tile, content)| (tile, content.len() as u32, content))
            .collect();
        let read = |k: usize, bytes: &mut Vec<u8>| {
            *bytes = contents[k].as_bytes().to_vec();
            Ok(())
        };
        let mut file = Vec::new();
        archive.write(&mut file, &tiles, read).unwrap();
        let number = |at: usize| u64::from_le_bytes(file[at..at + 8].try_into().unwrap());
        assert_eq!(&file[..8], b"PMTiles\x03");
        assert_eq!(number(8), 127);
        assert_eq!(
            (number(24), number(40), number(56)),
            (number(8) + number(16), number(24) + number(32), number(40) + number(48))
        );
        assert_eq!(number(56) + number(64), file.len() as u64);
        assert_eq!([number(72), number(80), number(88)], [5, 3, 3]);
        assert_eq!(file[96..102], [1, 2, 1, 2, 0, 1]);
        let degrees = |at: usize| i32::from_le_bytes(file[at..at + 4].try_into().unwrap());
        assert_eq!(
            [102, 106, 110, 114, 119, 123].map(degrees),
            [-100_000_000, -205_000_000, 300_000_000, 402_500_000, 100_000_000, 98_750_000]
        );
        assert_eq!(file[118], 1);
        // Along the curve: the three tiles of the sea are one run.
        assert_eq!(&file[number(56) as usize..], b"topsealand");
        let changed = archive.write(&mut Vec::new(), &tiles, |_, bytes| {
            bytes.clear();
            Ok(())
        });
        assert!(changed.unwrap_err().to_string().contains("the tile 0/0/0 has changed"));
    }
}
