//! Decompresses a strip or tile to the bytes of its samples.

use std::io::Read;

use lzma_rust2::XzReader;
use miniz_oxide::inflate::decompress_to_vec_zlib_with_limit;
use ruzstd::decoding::{BlockDecodingStrategy, FrameDecoder};

use crate::format::conversion::Conversion;
use crate::format::lerc;
use crate::format::stored::Stored;

/// The number of LERC compression in TIFF's tag 259.
const LERC: u64 = 34887;

/// The compression of a file's blocks.
#[derive(Debug, Clone, Copy)]
pub struct Packing {
    /// The value of TIFF's tag 259.
    pub method: u64,
    /// The additional compression of LERC blobs, from the second number of tag 50674: 0 none, 1 deflate, 2 Zstandard.
    pub outer: u64,
    /// Number of samples per pixel in a block.
    pub bands: usize,
    /// Number of bytes per sample.
    pub size: usize,
}

impl Packing {
    /// The maximum ratio of decompressed to compressed size of the method.
    #[must_use]
    pub fn max_growth(&self) -> u64 {
        match self.method {
            // 4096 is the longest run of a 12-bit LZW code; deflate has 1032.
            1 | 5 | 8 | 32946 | 32773 => 4096,
            // A block of one repeated byte has 4 bytes for 128 KiB.
            50000 => 1 << 15,
            // The longest run of LZMA is 273 bytes, and takes almost no bits.
            34925 => 1 << 15,
            // A block with a single value has only a header.
            _ => u64::MAX,
        }
    }

    /// Decompresses a block to exactly `length` bytes, which are `size` pixels. Fails if the data has more bytes.
    pub fn unpack(&self, packed: Vec<u8>, length: usize, size: [usize; 2]) -> Result<Vec<u8>, String> {
        let out = match self.method {
            1 => packed,
            5 => lzw(&packed, length)?,
            8 | 32946 => inflate(&packed, length)?,
            32773 => pack_bits(&packed, length),
            50000 => zstandard(&packed, length)?,
            34925 => lzma(&packed, length)?,
            LERC => {
                // A blob has at most the samples, a mask and a header.
                let most = length + length / 8 + 4096;
                let blob = match self.outer {
                    0 => packed,
                    1 => inflate(&packed, most)?,
                    2 => zstandard(&packed, most)?,
                    other => return Err(format!("its LERC is compressed with the unknown method {other}")),
                };
                lerc::unpack(&blob, size, self.bands, self.size)?
            }
            50001 => return Err(other("WebP")),
            6 | 7 => return Err(other("JPEG")),
            method => return Err(other(&format!("method {method}"))),
        };
        match out.len() >= length {
            true => Ok(out),
            false => Err(format!("a block holds {} bytes instead of {length}", out.len())),
        }
    }
}

fn other(method: &str) -> String {
    format!(
        "it is compressed with {method}, which is not supported (supported: none, LZW, deflate, PackBits, Zstandard, LZMA and LERC); compress it again, for example with \
         gdal_translate -co COMPRESS=DEFLATE"
    )
}

fn inflate(packed: &[u8], most: usize) -> Result<Vec<u8>, String> {
    decompress_to_vec_zlib_with_limit(packed, most)
        .map_err(|fault| format!("a block compressed with deflate is damaged ({fault})"))
}

/// Decompresses a single frame of Zstandard (RFC 8878).
pub fn zstandard(packed: &[u8], most: usize) -> Result<Vec<u8>, String> {
    let damaged = |fault: &dyn std::fmt::Display| format!("a block compressed with Zstandard is damaged ({fault})");
    let mut decoder = FrameDecoder::new();
    // Levels up to 22 have a window of 128 MiB; memory grows with the data.
    decoder.set_max_window_size(1 << 27);
    let mut input = packed;
    decoder.init(&mut input).map_err(|fault| damaged(&fault))?;
    let done = decoder
        .decode_blocks(&mut input, BlockDecodingStrategy::UptoBytes(most + 1))
        .map_err(|fault| damaged(&fault))?;
    if !done {
        return Err(format!("a block compressed with Zstandard holds more than the expected {most} bytes"));
    }
    let out = decoder.collect().unwrap_or_default();
    if out.len() > most { Err(damaged(&"it is too long")) } else { Ok(out) }
}

/// Decompresses LZMA2 in an xz container, as written by libtiff.
fn lzma(packed: &[u8], most: usize) -> Result<Vec<u8>, String> {
    let mut out = Vec::new();
    // The dictionary grows with the data; presets have at most 64 MiB.
    let read = XzReader::new_mem_limit(packed, false, 128 << 10).take(most as u64).read_to_end(&mut out);
    read.map_err(|fault| format!("a block compressed with LZMA is damaged ({fault})"))?;
    Ok(out)
}

/// Decompresses LZW of TIFF 6.0: codes of 9 to 12 bits, highest bit first, whose width grows one code early. Stops
/// after `most` bytes.
fn lzw(packed: &[u8], most: usize) -> Result<Vec<u8>, String> {
    const CLEAR: usize = 256;
    const END: usize = 257;
    const FIRST: usize = 258;
    let mut out: Vec<u8> = Vec::with_capacity(most.min(packed.len() * 4));
    // The position and length of each code's string in `out`. A string consists of its predecessor and the following
    // byte.
    let mut table: Vec<(usize, usize)> = Vec::with_capacity(4096 - FIRST);
    let (mut width, mut bits, mut held) = (9u32, 0u32, 0u32);
    let mut last: Option<(usize, usize)> = None;
    let mut bytes = packed.iter();
    while out.len() < most {
        while held < width {
            let Some(byte) = bytes.next() else { return Ok(out) };
            bits = bits << 8 | u32::from(*byte);
            held += 8;
        }
        held -= width;
        let code = (bits >> held) as usize;
        bits &= (1 << held) - 1;
        match code {
            CLEAR => {
                table.clear();
                (width, last) = (9, None);
                continue;
            }
            END => return Ok(out),
            _ => {}
        }
        if let Some((start, length)) = last
            && FIRST + table.len() < 4096
        {
            table.push((start, length + 1));
            if FIRST + table.len() >= (1 << width) - 1 && width < 12 {
                width += 1;
            }
        }
        let start = out.len();
        let length = if code < CLEAR {
            out.push(code as u8);
            1
        } else {
            let damaged = || "a block compressed with LZW is damaged".to_string();
            let (from, length) = code.checked_sub(FIRST).and_then(|k| table.get(k)).copied().ok_or_else(damaged)?;
            // Byte by byte, because the string may overlap its own copy.
            for k in from..from + length {
                let byte = out.get(k).copied().ok_or_else(damaged)?;
                out.push(byte);
            }
            length
        };
        last = Some((start, length));
    }
    Ok(out)
}

/// Decompresses Apple's PackBits: runs and literals. Stops after `most` bytes.
fn pack_bits(packed: &[u8], most: usize) -> Vec<u8> {
    let mut out = Vec::with_capacity(most.min(packed.len() * 4));
    let mut rest = packed;
    while let Some((&head, tail)) = rest.split_first() {
        rest = match head {
            0..=127 => {
                let count = (usize::from(head) + 1).min(tail.len());
                out.extend_from_slice(&tail[..count]);
                &tail[count..]
            }
            128 => tail,
            129..=255 => {
                let Some((&byte, tail)) = tail.split_first() else { break };
                out.resize(out.len() + 257 - usize::from(head), byte);
                tail
            }
        };
        if out.len() >= most {
            break;
        }
    }
    out
}

/// The layout of the bytes of a row.
#[derive(Debug, Clone, Copy)]
pub struct Layout {
    /// The number type of the samples, with 1, 2, 4 or 8 bytes.
    pub stored: Stored,
    /// The value of TIFF's tag 317: 1 none, 2 differences of integers, 3 floating point.
    pub predictor: u64,
    /// Number of interleaved samples per pixel.
    pub bands: usize,
}

impl Layout {
    /// Undoes the predictor of a row. Replaces `out` with the bits of its samples, right-aligned in 64 bits.
    pub fn row(&self, bytes: &mut [u8], out: &mut Vec<u64>) {
        let size = self.stored.size;
        let count = bytes.len() / size;
        out.clear();
        if self.predictor == 3 {
            for k in self.bands..bytes.len() {
                bytes[k] = bytes[k].wrapping_add(bytes[k - self.bands]);
            }
            // All highest bytes come first, then all second highest, independent of the byte order of the file.
            for plane in bytes.chunks_exact(count.max(1)).take(size) {
                if out.is_empty() {
                    out.extend(plane.iter().map(|byte| u64::from(*byte)));
                } else {
                    out.iter_mut().zip(plane).for_each(|(bits, byte)| *bits = *bits << 8 | u64::from(*byte));
                }
            }
            return;
        }
        self.stored.append_bits(bytes, out);
        if self.predictor == 2 {
            let mask = u64::MAX >> (64 - 8 * size);
            for i in self.bands..out.len() {
                out[i] = out[i].wrapping_add(out[i - self.bands]) & mask;
            }
        }
    }
}

/// The samples of one band in a row of pixels.
#[derive(Debug, Clone, Copy)]
pub struct Row {
    /// The layout of the row.
    pub layout: Layout,
    /// The first pixel that is read.
    pub first: usize,
    /// The index of the band among the interleaved ones.
    pub band: usize,
}

impl Row {
    /// The bits of the samples.
    fn samples<'a>(&self, row: &mut [u8], bits: &'a mut Vec<u64>) -> impl Iterator<Item = u64> + 'a {
        self.layout.row(row, bits);
        let bands = self.layout.bands;
        bits.iter().copied().skip(self.first * bands + self.band).step_by(bands)
    }

    /// Converts the samples of `row` to heights, as many as both have.
    pub fn convert(&self, row: &mut [u8], bits: &mut Vec<u64>, conversion: &mut Conversion, heights: &mut [f32]) {
        let stored = self.layout.stored;
        for (height, bits) in heights.iter_mut().zip(self.samples(row, bits)) {
            *height = conversion.height(stored.number(bits), stored.size);
        }
    }

    /// Sets heights to NaN where the sample, which is alpha, is 0.
    pub fn hide(&self, row: &mut [u8], bits: &mut Vec<u64>, heights: &mut [f32]) {
        for (height, alpha) in heights.iter_mut().zip(self.samples(row, bits)) {
            if alpha == 0 {
                *height = f32::NAN;
            }
        }
    }
}

/// Sets heights to NaN where a mask is 0. The first height belongs to pixel `first` of `row`. A pixel is one bit, or
/// `bands` bytes, of which the one with index `band` counts.
pub fn mask(row: &[u8], bits: u64, bands: usize, band: usize, first: usize, heights: &mut [f32]) {
    for (height, column) in heights.iter_mut().zip(first..) {
        let valid = match bits {
            1 => row.get(column / 8).is_some_and(|byte| byte >> (7 - column % 8) & 1 == 1),
            _ => row.get(column * bands + band).is_some_and(|byte| *byte != 0),
        };
        if !valid {
            *height = f32::NAN;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::stored::Kind;

    fn layout(size: usize, big_endian: bool, predictor: u64, bands: usize) -> Layout {
        Layout { stored: Stored { kind: Kind::Unsigned, size, big_endian }, predictor, bands }
    }

    #[test]
    fn lzw_of_the_specification() {
        // TIFF 6.0, section 13: 7 7 7 8 8 7 7 6 6 becomes clear, 7, 258, 8, 8, 258, 6, 6, end.
        let codes = [256u32, 7, 258, 8, 8, 258, 6, 6, 257];
        let mut bits = String::new();
        codes.iter().for_each(|code| bits.push_str(&format!("{code:09b}")));
        while !bits.len().is_multiple_of(8) {
            bits.push('0');
        }
        let packed: Vec<u8> = bits
            .as_bytes()
            .chunks(8)
            .map(|b| u8::from_str_radix(std::str::from_utf8(b).unwrap(), 2).unwrap())
            .collect();
        assert_eq!(lzw(&packed, 9).unwrap(), [7, 7, 7, 8, 8, 7, 7, 6, 6]);
        let lzw_packed = Packing { method: 5, outer: 0, bands: 1, size: 1 };
        let why = lzw_packed.unpack(packed[..4].to_vec(), 9, [9, 1]).unwrap_err();
        assert_eq!(why, "a block holds 3 bytes instead of 9");
        assert!(lzw(&[0xff, 0xff, 0xff, 0xff], 9).unwrap_err().contains("damaged"));
    }

    #[test]
    fn pack_bits_of_apples_note() {
        let packed = [0xFE, 0xAA, 0x02, 0x80, 0x00, 0x2A, 0xFD, 0xAA, 0x03, 0x80, 0x00, 0x2A, 0x22, 0xF7, 0xAA];
        let out = pack_bits(&packed, 24);
        assert_eq!(&out[..10], [0xAA, 0xAA, 0xAA, 0x80, 0x00, 0x2A, 0xAA, 0xAA, 0xAA, 0xAA]);
        assert_eq!(out.len(), 24);
    }

    #[test]
    fn predictors() {
        let mut out = Vec::new();
        layout(2, true, 2, 1).row(&mut [1, 0, 0, 2, 0xff, 0xff], &mut out);
        assert_eq!(out, [256, 258, 257]);
        // Two bands, each with its own prediction.
        layout(1, false, 2, 2).row(&mut [1, 10, 2, 20, 3, 30], &mut out);
        assert_eq!(out, [1, 10, 3, 30, 6, 60]);
        // Two floats, 1.0 and 2.0: planes 3f 40, 80 00, 00 00, 00 00, then differences.
        let planes = [0x3fu8, 0x40, 0x80, 0, 0, 0, 0, 0];
        let mut bytes: Vec<u8> =
            (0..8).map(|k| if k == 0 { planes[0] } else { planes[k].wrapping_sub(planes[k - 1]) }).collect();
        layout(4, false, 3, 1).row(&mut bytes, &mut out);
        assert_eq!(out, [u64::from(1f32.to_bits()), u64::from(2f32.to_bits())]);
    }

    #[test]
    fn other_methods_are_named() {
        for (method, name) in [(50000, "Zstandard"), (34925, "LZMA"), (34887, "LERC"), (7, "JPEG"), (99, "method 99")] {
            let packing = Packing { method, outer: 0, bands: 1, size: 1 };
            assert!(packing.unpack(vec![1], 1, [1, 1]).unwrap_err().contains(name));
        }
    }
}
