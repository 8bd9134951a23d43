//! Region files (`.mca`) of Minecraft: Java Edition, in the Anvil format: 32 x 32 chunks of 16 x 16 columns.
//!
//! A file begins with the places of its chunks in sectors of 4096 bytes, and with their times, which are all 0 here, so
//! that equal chunks give equal files. Each chunk is NBT compressed with zlib.

use std::io::{self, Write};

use miniz_oxide::deflate::compress_to_vec_zlib;

/// Number of chunks along a side of a region.
pub const CHUNKS: usize = 32;

/// Number of columns along a side of a chunk.
pub const COLUMNS: usize = 16;

/// Number of columns along a side of a region.
pub const SIDE: usize = CHUNKS * COLUMNS;

/// Number of bytes of a sector.
const SECTOR: usize = 4096;

/// Maximum number of sectors of a chunk in a region file.
const MAX_SECTORS: usize = 255;

/// Compression level.
const LEVEL: u8 = 6;

/// The number of the compression: zlib.
const ZLIB: u8 = 2;

/// A chunk as it is stored: compressed, with its header, in whole sectors.
#[derive(Debug, Clone, Default)]
pub struct PackedChunk(Vec<u8>);

impl PackedChunk {
    /// Compresses the NBT of a chunk.
    ///
    /// # Errors
    /// If it takes more than 255 sectors.
    pub fn of(tags: &[u8]) -> io::Result<PackedChunk> {
        let packed = compress_to_vec_zlib(tags, LEVEL);
        let mut bytes = Vec::with_capacity((packed.len() + 5).next_multiple_of(SECTOR));
        bytes.extend_from_slice(&(packed.len() as u32 + 1).to_be_bytes());
        bytes.push(ZLIB);
        bytes.extend_from_slice(&packed);
        bytes.resize(bytes.len().next_multiple_of(SECTOR), 0);
        if bytes.len() > MAX_SECTORS * SECTOR {
            return Err(io::Error::other("a chunk has more than 255 sectors, the most that a region file can hold"));
        }
        Ok(PackedChunk(bytes))
    }

    /// Number of bytes.
    #[must_use]
    pub fn size(&self) -> u64 {
        self.0.len() as u64
    }
}

/// The name of a region file, in the folder `region` of a world.
#[must_use]
pub fn region_name([x, z]: [i64; 2]) -> String {
    format!("r.{x}.{z}.mca")
}

/// Writes a region file of 1024 chunks, row by row from the north; empty ones are absent.
///
/// # Errors
/// If `out` fails.
pub fn write_region(out: &mut dyn Write, chunks: &[PackedChunk]) -> io::Result<()> {
    let mut places = [0; SECTOR];
    let mut next = 2;
    for (place, chunk) in places.chunks_exact_mut(4).zip(chunks).filter(|(_, chunk)| !chunk.0.is_empty()) {
        let sectors = chunk.0.len() / SECTOR;
        place.copy_from_slice(&((next << 8 | sectors) as u32).to_be_bytes());
        next += sectors;
    }
    out.write_all(&places)?;
    out.write_all(&[0; SECTOR])?;
    chunks.iter().take(CHUNKS * CHUNKS).try_for_each(|chunk| out.write_all(&chunk.0))
}

/// Packs numbers below `1 << bits` into longs from the lowest bits on. No number spans two longs.
#[must_use]
pub fn packed_longs(numbers: &[u16], bits: u32) -> Vec<u64> {
    let each = (64 / bits) as usize;
    let pack = |part: &[u16]| part.iter().rev().fold(0, |long, number| long << bits | u64::from(*number));
    numbers.chunks(each).map(pack).collect()
}

/// The bits of an index into a palette of this length; 0 for a palette of one entry.
#[must_use]
pub fn palette_bits(length: usize) -> u32 {
    usize::BITS - length.saturating_sub(1).leading_zeros()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chunks_are_in_sectors_of_their_own() {
        let mut chunks = vec![PackedChunk::default(); CHUNKS * CHUNKS];
        let long: Vec<u8> = (0..20_000u32).map(|k| (k.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
        chunks[0] = PackedChunk::of(b"first").unwrap();
        chunks[33] = PackedChunk::of(&long).unwrap();
        let mut file = Vec::new();
        write_region(&mut file, &chunks).unwrap();
        let chunk = |at: usize| {
            let [a, b, c, sectors] = file[4 * at..4 * at + 4].try_into().unwrap();
            let start = u32::from_be_bytes([0, a, b, c]) as usize * SECTOR;
            let length = u32::from_be_bytes(file[start..start + 4].try_into().unwrap()) as usize;
            assert!(length + 4 <= usize::from(sectors) * SECTOR && file[start + 4] == 2);
            miniz_oxide::inflate::decompress_to_vec_zlib(&file[start + 5..start + 4 + length]).unwrap()
        };
        assert_eq!(file.len() % SECTOR, 0);
        assert!(chunk(0) == b"first" && chunk(33) == long);
        assert_eq!(file[4..8], [0; 4], "a chunk that is absent");
        assert_eq!(region_name([-1, 0]), "r.-1.0.mca");
        let hard: Vec<u8> = (0..300_000u32).flat_map(|k| crc32fast::hash(&k.to_be_bytes()).to_be_bytes()).collect();
        assert!(PackedChunk::of(&hard).unwrap_err().to_string().contains("255 sectors"));
    }

    #[test]
    fn numbers_span_no_two_longs() {
        let numbers: Vec<u16> = (0..20).collect();
        let longs = packed_longs(&numbers, 5);
        assert_eq!(longs.len(), 2);
        for (k, number) in numbers.iter().enumerate() {
            assert_eq!(longs[k / 12] >> (5 * (k % 12)) & 31, u64::from(*number));
        }
        assert_eq!([1, 2, 3, 4, 5, 16, 17].map(palette_bits), [0, 1, 2, 2, 3, 4, 5]);
    }
}
