//! Decompression of Zarr chunks: gzip, zlib, Zstandard, LZ4 and frames of C-Blosc.

use miniz_oxide::inflate::{decompress_to_vec_with_limit, decompress_to_vec_zlib_with_limit};

use crate::format::geotiff::unpack::zstandard;

/// A codec of a chunk's bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Codec {
    /// gzip (RFC 1952).
    Gzip,
    /// zlib (RFC 1950).
    Zlib,
    /// Zstandard.
    Zstandard,
    /// A block of LZ4 preceded by its length.
    Lz4,
    /// A frame of C-Blosc.
    Blosc,
    /// A trailing checksum of four bytes, which is not verified.
    Checksum,
}

impl Codec {
    /// The codec with this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Codec> {
        match name {
            "gzip" => Some(Codec::Gzip),
            "zlib" | "numcodecs.zlib" => Some(Codec::Zlib),
            "zstd" | "numcodecs.zstd" => Some(Codec::Zstandard),
            "lz4" | "numcodecs.lz4" => Some(Codec::Lz4),
            "blosc" | "numcodecs.blosc" => Some(Codec::Blosc),
            "crc32c" => Some(Codec::Checksum),
            _ => None,
        }
    }

    /// Decompresses at most `most` bytes.
    ///
    /// # Errors
    /// A message if the bytes are damaged, or if there would be more.
    pub fn unpack(self, packed: &[u8], most: usize) -> Result<Vec<u8>, String> {
        let damaged = || "a chunk is damaged".to_string();
        match self {
            Codec::Gzip => gzip(packed, most).ok_or_else(damaged),
            Codec::Zlib => decompress_to_vec_zlib_with_limit(packed, most).map_err(|_| damaged()),
            Codec::Zstandard => zstandard(packed, most),
            Codec::Lz4 => lz4(packed.get(4..).ok_or_else(damaged)?, most),
            Codec::Blosc => blosc(packed, most),
            Codec::Checksum => Ok(packed.get(..packed.len().saturating_sub(4)).ok_or_else(damaged)?.to_vec()),
        }
    }
}

fn gzip(packed: &[u8], most: usize) -> Option<Vec<u8>> {
    let [0x1f, 0x8b, 8, flags, ..] = packed else { return None };
    let mut at = 10;
    if flags & 4 != 0 {
        at += 2 + usize::from(u16::from_le_bytes([*packed.get(at)?, *packed.get(at + 1)?]));
    }
    for flag in [8, 16] {
        if flags & flag != 0 {
            at += packed.get(at..)?.iter().position(|byte| *byte == 0)? + 1;
        }
    }
    if flags & 2 != 0 {
        at += 2;
    }
    decompress_to_vec_with_limit(packed.get(at..)?, most).ok()
}

fn lz4(packed: &[u8], most: usize) -> Result<Vec<u8>, String> {
    // Allocates only as much as the bytes can expand to, which is a factor of 255.
    let mut out = vec![0; most.min(packed.len().saturating_mul(255))];
    let length = lz4_flex::block::decompress_into(packed, &mut out)
        .map_err(|_| "a chunk compressed with LZ4 is damaged".to_string())?;
    out.truncate(length);
    Ok(out)
}

/// Minimum number of bytes per stream for which a block is split into one stream per byte of its numbers.
const MIN_PART: usize = 128;

/// Decompresses a frame of C-Blosc 1 (README_CHUNK_FORMAT.rst).
fn blosc(frame: &[u8], most: usize) -> Result<Vec<u8>, String> {
    let damaged = || "a chunk compressed with Blosc is damaged".to_string();
    let number = |at: usize| {
        let four = frame.get(at..at + 4)?;
        Some(u32::from_le_bytes([four[0], four[1], four[2], four[3]]) as usize)
    };
    let (Some(&[_, _, flags, size]), Some(length), Some(block)) = (frame.get(..4), number(4), number(8)) else {
        return Err(damaged());
    };
    let size = usize::from(size).max(1);
    if length > most {
        return Err(damaged());
    }
    if flags & 2 != 0 {
        return Ok(frame.get(16..16 + length).ok_or_else(damaged)?.to_vec());
    }
    if flags & 4 != 0 {
        return Err("a chunk is compressed with Blosc and bit shuffle, which is not supported".into());
    }
    let unpack = |packed: &[u8], due: usize| match flags >> 5 {
        1 => lz4(packed, due),
        3 => Codec::Zlib.unpack(packed, due),
        4 => zstandard(packed, due),
        0 => Err("a chunk is compressed with Blosc with BloscLZ, which is not supported".into()),
        _ => Err("a chunk is compressed with Blosc in a way that is not supported".to_string()),
    };
    if block == 0 && length > 0 {
        return Err(damaged());
    }
    let mut out = Vec::new();
    for k in 0..if length == 0 { 0 } else { length.div_ceil(block) } {
        let here = block.min(length - k * block);
        let parts = match flags & 16 == 0 && size <= 16 && block / size >= MIN_PART && here == block {
            true => size,
            false => 1,
        };
        let mut at = number(16 + 4 * k).ok_or_else(damaged)?;
        let mut bytes = Vec::new();
        for _ in 0..parts {
            let packed =
                at.checked_add(4).zip(number(at)).and_then(|(from, length)| frame.get(from..from.checked_add(length)?));
            let packed = packed.ok_or_else(damaged)?;
            at += 4 + packed.len();
            match packed.len() == here / parts {
                true => bytes.extend_from_slice(packed),
                false => bytes.extend(unpack(packed, here / parts)?),
            }
        }
        if bytes.len() != here {
            return Err(damaged());
        }
        match flags & 1 != 0 && size > 1 {
            true => {
                let count = here / size;
                let whole = count * size;
                out.extend((0..whole).map(|at| bytes[at % size * count + at / size]));
                out.extend_from_slice(&bytes[whole..]);
            }
            false => out.append(&mut bytes),
        }
    }
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::zarr::blosc as writer;

    #[test]
    fn frames_of_our_own_come_back() {
        let ramp: Vec<u8> = (0..1000).flat_map(|n| (n as f32 * 0.37).to_le_bytes()).collect();
        let frame = writer::pack(&ramp, 4).unwrap();
        assert_eq!(Codec::Blosc.unpack(&frame, 4000), Ok(ramp));
        assert!(Codec::Blosc.unpack(&frame, 3999).is_err() && Codec::Blosc.unpack(&frame[..900], 4000).is_err());
        for n in 0..frame.len() {
            let mut frame = frame.clone();
            frame[n] ^= 0x55;
            // Any result is accepted, but no panic.
            let _ = Codec::Blosc.unpack(&frame, 4000);
        }
    }

    #[test]
    fn gzip_of_its_tool() {
        // gzip -n of "abc".
        let packed = [0x1f, 0x8b, 8, 0, 0, 0, 0, 0, 0, 3, 0x4b, 0x4c, 0x4a, 6, 0, 0xc2, 0x41, 0x24, 0x35, 3, 0, 0, 0];
        assert_eq!(Codec::Gzip.unpack(&packed, 3), Ok(b"abc".to_vec()));
        assert!(Codec::Gzip.unpack(&packed, 2).is_err());
    }
}
