//! The codec `blosc`: byte shuffle, then zlib, in a frame of C-Blosc 1.
//!
//! The frame (C-Blosc `README_CHUNK_FORMAT.rst`, format version 2) consists of a header of sixteen bytes, the offset of
//! each block, and the blocks, each preceded by its length. This module writes a single block.

use miniz_oxide::deflate::compress_to_vec_zlib;

/// Compression level. Half of a height's bits are noise for deflate, so higher levels take longer and save only 1 %.
pub const LEVEL: u8 = 3;

/// The version of the frame, and the version of its zlib format.
const VERSIONS: [u8; 2] = [2, 1];

/// Flags: shuffled bytes, blocks that are not split into one stream per byte of a number, zlib.
const SHUFFLED: u8 = 1;
const WHOLE: u8 = 1 << 4;
const ZLIB: u8 = 3 << 5;

/// Number of bytes before the block: the header, the offset of the block, and its length.
const HEADER: usize = 16;
const BEFORE: usize = HEADER + 4 + 4;

/// Compresses numbers of `size` bytes each; `None` if they are too long for a frame (about 2 GiB).
#[must_use]
pub fn pack(bytes: &[u8], size: u8) -> Option<Vec<u8>> {
    let length = i32::try_from(bytes.len() + BEFORE).ok()? as usize - BEFORE;
    let shuffled = shuffle(bytes, usize::from(size));
    let packed = compress_to_vec_zlib(&shuffled, LEVEL);
    // A block that is as long as its content counts as uncompressed.
    let block = if packed.len() < length { &packed } else { &shuffled };
    let mut out = Vec::with_capacity(BEFORE + block.len());
    out.extend_from_slice(&VERSIONS);
    out.extend_from_slice(&[SHUFFLED | WHOLE | ZLIB, size]);
    for number in [length, length, BEFORE + block.len(), HEADER + 4, block.len()] {
        out.extend_from_slice(&(number as u32).to_le_bytes());
    }
    out.extend_from_slice(block);
    Some(out)
}

/// Stores the first bytes of all numbers, then all second bytes, and so on.
fn shuffle(bytes: &[u8], size: usize) -> Vec<u8> {
    let mut out = Vec::with_capacity(bytes.len());
    for k in 0..size {
        out.extend(bytes.iter().skip(k).step_by(size));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use miniz_oxide::inflate::decompress_to_vec_zlib;

    /// Reads a frame as specified, independently of the writer.
    fn unpack(frame: &[u8]) -> Vec<u8> {
        let number = |at: usize| u32::from_le_bytes(frame[at..at + 4].try_into().unwrap()) as usize;
        assert_eq!((frame[0], frame[1], frame[2] & 2, frame[2] >> 5), (2, 1, 0, 3));
        let (size, length, block_size, all) = (usize::from(frame[3]), number(4), number(8), number(12));
        assert_eq!(all, frame.len());
        let mut out = Vec::new();
        for block in 0..length.div_ceil(block_size) {
            let start = number(16 + 4 * block);
            let packed = &frame[start + 4..start + 4 + number(start)];
            let here = block_size.min(length - block * block_size);
            let block = if packed.len() == here { packed.to_vec() } else { decompress_to_vec_zlib(packed).unwrap() };
            assert_eq!(block.len(), here);
            let count = here / size;
            out.extend((0..here).map(|at| block[at % size * count + at / size]));
        }
        out
    }

    #[test]
    fn frames_come_back() {
        let ramp: Vec<u8> = (0..1000).flat_map(|n| (n as f32 * 0.37).to_le_bytes()).collect();
        let frame = pack(&ramp, 4).unwrap();
        assert!(frame.len() < 3000, "{}", frame.len());
        assert_eq!(unpack(&frame), ramp);
        // Incompressible data is stored uncompressed.
        let mut state = 1u32;
        let noise: Vec<u8> = (0..256)
            .map(|_| {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                (state >> 24) as u8
            })
            .collect();
        let frame = pack(&noise, 8).unwrap();
        assert_eq!((frame.len(), unpack(&frame)), (BEFORE + noise.len(), noise));
    }
}
