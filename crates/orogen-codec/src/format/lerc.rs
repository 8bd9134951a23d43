//! LERC (Limited Error Raster Compression, "Lerc2", versions 3 to 6) by Esri, as used in GeoTIFF files.
//!
//! A blob is a header, a mask of valid pixels, and the values. The values are one sequence, Huffman codes of bytes, or
//! square blocks of integers with as many bits as the largest one needs: value = offset + 2 error number. A Fletcher
//! checksum covers the whole blob. This decoder follows Esri's description of the format and the behavior of Esri's
//! decoder (github.com/Esri/lerc, Apache 2.0).

/// Sizes in bytes of the sample types, by their numbers in the format.
const SIZES: [usize; 8] = [1, 1, 2, 2, 4, 4, 4, 8];
const CHAR: usize = 0;
const BYTE: usize = 1;
const FLOAT: usize = 6;
const DOUBLE: usize = 7;

/// Maximum number of codes in a Huffman table.
const MAX_CODES: usize = 1 << 15;

/// Decodes a blob of `width` x `height` pixels with `bands` samples of `size` bytes. Returns little-endian samples,
/// with the bands of a pixel interleaved. Masked pixels are NaN, or 0 for integers.
///
/// # Errors
/// A message if the blob is damaged, has another size, or uses an unsupported encoding.
pub fn unpack(packed: &[u8], [width, height]: [usize; 2], bands: usize, size: usize) -> Result<Vec<u8>, String> {
    let mut input = Input { bytes: packed };
    let head = Head::read(&mut input, packed)?;
    let (columns, rows) = (head.columns, head.rows);
    // The last strip of a file may be encoded with its actual height.
    if columns != width || rows > height || head.bands != bands || SIZES[head.kind] != size {
        return Err(format!(
            "a block compressed with LERC holds {columns} x {rows} pixels with {} bands of {} bytes instead of {width} x {height} with {bands} of {size}",
            head.bands, SIZES[head.kind]
        ));
    }
    let valid = mask(&mut input, &head)?;
    let mut values = Values { out: vec![0; rows * columns * bands * size], head, valid };
    values.read(&mut input)?;
    values.leave_out();
    Ok(values.out)
}

fn damaged() -> String {
    "a block compressed with LERC is damaged".into()
}

/// Bytes that are consumed from the front.
#[derive(Clone, Copy)]
struct Input<'a> {
    bytes: &'a [u8],
}

impl<'a> Input<'a> {
    fn take(&mut self, count: usize) -> Result<&'a [u8], String> {
        let (head, rest) = self.bytes.split_at_checked(count).ok_or_else(damaged)?;
        self.bytes = rest;
        Ok(head)
    }

    fn byte(&mut self) -> Result<u8, String> {
        Ok(self.take(1)?[0])
    }

    fn whole(&mut self, size: usize) -> Result<u32, String> {
        Ok(self.take(size)?.iter().rev().fold(0, |number, byte| number << 8 | u32::from(*byte)))
    }

    fn int(&mut self) -> Result<i32, String> {
        Ok(self.whole(4)? as i32)
    }

    /// Reads a size, which must not be negative.
    fn count(&mut self) -> Result<usize, String> {
        usize::try_from(self.int()?).map_err(|_| damaged())
    }

    /// Reads a value of type `kind`.
    fn value(&mut self, kind: usize) -> Result<f64, String> {
        let bytes = self.take(SIZES[kind])?;
        let bits = bytes.iter().rev().fold(0u64, |bits, byte| bits << 8 | u64::from(*byte));
        Ok(match kind {
            CHAR => f64::from(bits as u8 as i8),
            2 => f64::from(bits as u16 as i16),
            4 => f64::from(bits as u32 as i32),
            FLOAT => f64::from(f32::from_bits(bits as u32)),
            DOUBLE => f64::from_bits(bits),
            _ => bits as f64,
        })
    }
}

struct Head {
    version: i32,
    rows: usize,
    columns: usize,
    bands: usize,
    valid: usize,
    /// Side of a block, in pixels.
    side: usize,
    kind: usize,
    error: f64,
    low: f64,
    high: f64,
}

impl Head {
    fn read(input: &mut Input, packed: &[u8]) -> Result<Head, String> {
        if input.take(6)? != b"Lerc2 " {
            return Err("a block is compressed with a version of LERC other than Lerc2, which is not supported".into());
        }
        let version = input.int()?;
        if !(3..=6).contains(&version) {
            return Err(format!("a block is compressed with LERC version {version}; versions 3 to 6 are supported"));
        }
        let checksum = input.whole(4)?;
        let before = packed.len() - input.bytes.len();
        let (rows, columns) = (input.count()?, input.count()?);
        let bands = if version >= 4 { input.count()? } else { 1 };
        let (valid, side, length) = (input.count()?, input.count()?, input.count()?);
        let kind = input.count()?;
        let blob = packed.get(before..length).ok_or_else(damaged)?;
        if fletcher(blob) != checksum {
            return Err(damaged());
        }
        if version >= 6 {
            input.take(8)?;
        }
        let [error, low, high] = [input.value(DOUBLE)?, input.value(DOUBLE)?, input.value(DOUBLE)?];
        if version >= 6 {
            input.take(16)?;
        }
        let pixels = rows.checked_mul(columns).ok_or_else(damaged)?;
        if pixels == 0 || bands == 0 || valid > pixels || !(1..=1 << 16).contains(&side) || kind >= SIZES.len() {
            return Err(damaged());
        }
        Ok(Head { version, rows, columns, bands, valid, side, kind, error, low, high })
    }
}

/// The 32-bit Fletcher checksum over pairs of bytes, the higher byte first.
fn fletcher(bytes: &[u8]) -> u32 {
    let (mut low, mut high) = (0xffffu32, 0xffffu32);
    let fold = |sum: u32| (sum & 0xffff) + (sum >> 16);
    for piece in bytes.chunks(2 * 359) {
        for pair in piece.chunks(2) {
            low += u32::from(pair[0]) << 8 | u32::from(pair.get(1).copied().unwrap_or(0));
            high += low;
        }
        (low, high) = (fold(low), fold(high));
    }
    fold(high) << 16 | fold(low)
}

/// Reads the mask of valid pixels; `None` if all pixels are valid.
fn mask(input: &mut Input, head: &Head) -> Result<Option<Vec<u8>>, String> {
    let length = input.count()?;
    let pixels = head.rows * head.columns;
    let full = pixels.div_ceil(8);
    if length == 0 {
        return match head.valid {
            0 => Ok(Some(vec![0; full])),
            all if all == pixels => Ok(None),
            _ => Err(damaged()),
        };
    }
    let mut runs = Input { bytes: input.take(length)? };
    let mut bits = Vec::new();
    loop {
        let count = runs.whole(2)? as u16 as i16;
        match count {
            i16::MIN => break,
            0.. => bits.extend_from_slice(runs.take(count as usize)?),
            _ => {
                let byte = runs.byte()?;
                bits.resize(bits.len() + usize::from(count.unsigned_abs()), byte);
            }
        }
        if bits.len() > full {
            return Err(damaged());
        }
    }
    let inside = |bits: &[u8]| (0..pixels).filter(|k| is_set(bits, *k)).count();
    if bits.len() != full || inside(&bits) != head.valid {
        return Err(damaged());
    }
    Ok(Some(bits))
}

fn is_set(bits: &[u8], k: usize) -> bool {
    bits[k / 8] & 0x80 >> (k % 8) != 0
}

/// Reads `count` integers of `width` bits each, the lowest bit first.
fn bits(input: &mut Input, count: usize, width: usize) -> Result<Vec<u32>, String> {
    let bytes = input.take((count * width).div_ceil(8))?;
    let mut numbers = Vec::with_capacity(count);
    let (mut held, mut there, mut next) = (0u64, 0, bytes.iter());
    for _ in 0..count {
        while there < width {
            held |= u64::from(next.next().copied().unwrap_or(0)) << there;
            there += 8;
        }
        numbers.push((held & ((1u64 << width) - 1)) as u32);
        held >>= width;
        there -= width;
    }
    Ok(numbers)
}

/// Reads at most `most` numbers, which are bit-packed or indices into a table.
fn numbers(input: &mut Input, most: usize) -> Result<Vec<u32>, String> {
    let first = input.byte()?;
    let size = match first >> 6 {
        0 => 4,
        1 => 2,
        2 => 1,
        _ => return Err(damaged()),
    };
    let width = usize::from(first & 31);
    let count = input.whole(size)? as usize;
    if count > most {
        return Err(damaged());
    }
    if first & 1 << 5 == 0 {
        return if width == 0 { Ok(vec![0; count]) } else { bits(input, count, width) };
    }
    let entries = usize::from(input.byte()?).checked_sub(1).filter(|n| *n > 0 && width > 0).ok_or_else(damaged)?;
    // The first entry is 0 and is not stored.
    let table = [vec![0], bits(input, entries, width)?].concat();
    let width = (usize::BITS - entries.leading_zeros()) as usize;
    let places = bits(input, count, width)?;
    places.iter().map(|place| table.get(*place as usize).copied().ok_or_else(damaged)).collect()
}

/// The decoded samples.
struct Values {
    out: Vec<u8>,
    head: Head,
    valid: Option<Vec<u8>>,
}

impl Values {
    fn is_valid(&self, pixel: usize) -> bool {
        self.valid.as_ref().is_none_or(|bits| is_set(bits, pixel))
    }

    /// Sets a sample, converted to the type of the blob.
    fn set(&mut self, pixel: usize, band: usize, value: f64) {
        let size = SIZES[self.head.kind];
        let at = (pixel * self.head.bands + band) * size;
        let bytes = match self.head.kind {
            CHAR => (value as i8 as u8 as u64).to_le_bytes(),
            2 => (value as i16 as u16 as u64).to_le_bytes(),
            4 => (value as i32 as u32 as u64).to_le_bytes(),
            FLOAT => u64::from((value as f32).to_bits()).to_le_bytes(),
            DOUBLE => value.to_bits().to_le_bytes(),
            _ => (value as u64).to_le_bytes(),
        };
        self.out[at..at + size].copy_from_slice(&bytes[..size]);
    }

    fn read(&mut self, input: &mut Input) -> Result<(), String> {
        let Head { version, bands, valid, kind, low, high, error, .. } = self.head;
        let constant = |values: &mut Values, of: &dyn Fn(usize) -> f64| {
            for pixel in 0..values.head.rows * values.head.columns {
                if values.is_valid(pixel) {
                    (0..bands).for_each(|band| values.set(pixel, band, of(band)));
                }
            }
        };
        if valid == 0 {
            return Ok(());
        }
        if low == high {
            constant(self, &|_| low);
            return Ok(());
        }
        let mut highest = vec![high; bands];
        if version >= 4 {
            let lows: Vec<f64> = (0..bands).map(|_| input.value(kind)).collect::<Result<_, _>>()?;
            let highs: Vec<f64> = (0..bands).map(|_| input.value(kind)).collect::<Result<_, _>>()?;
            if lows == highs {
                constant(self, &|band| lows[band]);
                return Ok(());
            }
            if bands > 1 {
                highest = highs;
            }
        }
        if input.byte()? != 0 {
            for pixel in 0..self.head.rows * self.head.columns {
                if self.is_valid(pixel) {
                    for band in 0..bands {
                        let value = input.value(kind)?;
                        self.set(pixel, band, value);
                    }
                }
            }
            return Ok(());
        }
        // Since version 6, lossless floats have another byte here.
        let of_bytes = matches!(kind, CHAR | BYTE) && error == 0.5;
        if of_bytes || version >= 6 && matches!(kind, FLOAT | DOUBLE) && error == 0.0 {
            match input.byte()? {
                0 => {}
                1 if of_bytes => return self.huffman(input, true),
                2 if of_bytes && version >= 4 => return self.huffman(input, false),
                _ => return Err("a block is compressed with a kind of LERC that is not supported".into()),
            }
        }
        let Head { rows, columns, side, .. } = self.head;
        for top in (0..rows).step_by(side) {
            for left in (0..columns).step_by(side) {
                let pixels: Vec<usize> = (top..(top + side).min(rows))
                    .flat_map(|j| (left..(left + side).min(columns)).map(move |i| j * columns + i))
                    .collect();
                for (band, high) in highest.iter().enumerate() {
                    self.block(input, &pixels, left, band, *high)?;
                }
            }
        }
        Ok(())
    }

    /// Decodes a block of a band.
    fn block(
        &mut self,
        input: &mut Input,
        pixels: &[usize],
        left: usize,
        band: usize,
        high: f64,
    ) -> Result<(), String> {
        let Head { version, kind, error, .. } = self.head;
        let flag = input.byte()?;
        let pattern = if version >= 5 { 14 } else { 15 };
        if usize::from(flag >> 2) & pattern != left >> 3 & pattern {
            return Err(damaged());
        }
        if version >= 5 && flag & 4 != 0 {
            return Err("a block is compressed with LERC as differences between bands, which is not supported".into());
        }
        let valid: Vec<usize> = pixels.iter().copied().filter(|pixel| self.is_valid(*pixel)).collect();
        match flag & 3 {
            0 => {
                for pixel in valid {
                    let value = input.value(kind)?;
                    self.set(pixel, band, value);
                }
            }
            2 => valid.into_iter().for_each(|pixel| self.set(pixel, band, 0.0)),
            how => {
                let offset = input.value(smaller(kind, usize::from(flag >> 6))?)?;
                if how == 3 {
                    valid.into_iter().for_each(|pixel| self.set(pixel, band, offset));
                    return Ok(());
                }
                let numbers = numbers(input, pixels.len())?;
                if numbers.len() != valid.len() {
                    return Err(damaged());
                }
                for (pixel, number) in valid.into_iter().zip(numbers) {
                    self.set(pixel, band, (offset + f64::from(number) * 2.0 * error).min(high));
                }
            }
        }
        Ok(())
    }

    /// Decodes Huffman codes of bytes, or of differences to the pixel to the left or above.
    fn huffman(&mut self, input: &mut Input, differences: bool) -> Result<(), String> {
        let Head { rows, columns, bands, kind, .. } = self.head;
        let codes = Codes::read(input)?;
        let mut stream = Words { bytes: input.bytes, at: 0 };
        let offset = if kind == CHAR { 128 } else { 0 };
        let next = |stream: &mut Words| Ok::<u8, String>((codes.next(stream)? as u8).wrapping_sub(offset));
        if !differences {
            for pixel in (0..rows * columns).filter(|pixel| self.valid.as_ref().is_none_or(|bits| is_set(bits, *pixel)))
            {
                for band in 0..bands {
                    self.out[pixel * bands + band] = next(&mut stream)?;
                }
            }
            return Ok(());
        }
        for band in 0..bands {
            let mut last = 0u8;
            for pixel in 0..rows * columns {
                if !self.is_valid(pixel) {
                    continue;
                }
                let before = match pixel {
                    k if k % columns > 0 && self.is_valid(k - 1) => last,
                    k if k >= columns && self.is_valid(k - columns) => self.out[(k - columns) * bands + band],
                    _ => last,
                };
                last = next(&mut stream)?.wrapping_add(before);
                self.out[pixel * bands + band] = last;
            }
        }
        Ok(())
    }

    /// Sets masked floats to NaN.
    fn leave_out(&mut self) {
        if self.valid.is_none() || !matches!(self.head.kind, FLOAT | DOUBLE) {
            return;
        }
        for pixel in 0..self.head.rows * self.head.columns {
            if !self.is_valid(pixel) {
                (0..self.head.bands).for_each(|band| self.set(pixel, band, f64::NAN));
            }
        }
    }
}

/// The type of an offset, from the format's table of smaller types.
fn smaller(kind: usize, code: usize) -> Result<usize, String> {
    let smaller = match kind {
        2 | 4 => kind.checked_sub(code),
        3 | 5 => kind.checked_sub(2 * code),
        FLOAT => Some([FLOAT, 2, BYTE, BYTE][code]),
        DOUBLE if code > 0 => Some(DOUBLE - 2 * code + 1),
        _ => Some(kind),
    };
    smaller.ok_or_else(damaged)
}

/// Little-endian 32-bit words, read from the highest bit on.
struct Words<'a> {
    bytes: &'a [u8],
    /// Number of bits that were read.
    at: usize,
}

impl Words<'_> {
    fn bit(&mut self) -> Result<u32, String> {
        let word = self.at / 32 * 4;
        let four = self.bytes.get(word..word + 4).ok_or_else(damaged)?;
        let word = u32::from_le_bytes([four[0], four[1], four[2], four[3]]);
        let bit = word >> (31 - self.at % 32) & 1;
        self.at += 1;
        Ok(bit)
    }
}

/// Huffman codes: for each length, the sorted codes with their symbols.
struct Codes {
    by_length: Vec<Vec<(u32, u32)>>,
}

impl Codes {
    fn read(input: &mut Input) -> Result<Codes, String> {
        let (version, size, from, to) = (input.int()?, input.count()?, input.count()?, input.count()?);
        if version < 2 || from >= to || size > MAX_CODES || to - from > size || to > 2 * size {
            return Err(damaged());
        }
        let lengths = numbers(input, to - from)?;
        if lengths.len() != to - from || lengths.iter().any(|length| *length > 32) {
            return Err(damaged());
        }
        let mut words = Words { bytes: input.bytes, at: 0 };
        let mut by_length = vec![Vec::new(); 33];
        for (k, length) in lengths.iter().enumerate().filter(|(_, length)| **length > 0) {
            let mut code = 0;
            for _ in 0..*length {
                code = code << 1 | words.bit()?;
            }
            by_length[*length as usize].push((code, ((from + k) % size) as u32));
        }
        input.take(words.at.div_ceil(32) * 4)?;
        by_length.iter_mut().for_each(|codes| codes.sort_unstable());
        Ok(Codes { by_length })
    }

    fn next(&self, words: &mut Words) -> Result<u32, String> {
        let mut code = 0;
        for codes in &self.by_length[1..] {
            code = code << 1 | words.bit()?;
            if let Ok(k) = codes.binary_search_by_key(&code, |(code, _)| *code) {
                return Ok(codes[k].1);
            }
        }
        Err(damaged())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_any_width() {
        let packed = [0b1010_1100, 0b0000_0001];
        assert_eq!(bits(&mut Input { bytes: &packed }, 3, 3).unwrap(), [4, 5, 6]);
        // Three entries of 4 bits: 0, which is not stored, 9 and 12. Then indices of 2 bits: 2, 0, 1.
        let table = [0b1010_0100, 3, 3, 0xC9, 0b0001_0010];
        assert_eq!(numbers(&mut Input { bytes: &table }, 3).unwrap(), [12, 0, 9]);
        assert!(numbers(&mut Input { bytes: &table }, 2).is_err());
    }

    #[test]
    fn checksum_of_known_bytes() {
        // Wikipedia's "abcdef", by pairs with the higher byte first and from 0xffff.
        assert_eq!(fletcher(b""), 0xffff_ffff);
        assert_eq!(fletcher(&[0, 1]), 0x0001_0001);
    }

    /// Damage with a valid checksum: a file of another program, changed at one byte at a time, with the checksum
    /// recomputed.
    #[test]
    fn sealed_damage_is_samples_or_a_sentence() {
        let corpus = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus/dem");
        let (mut read, mut refused) = (0, 0);
        for (name, size, bands, bytes) in [
            ("u8-tiles-lerc.tif", [16, 16], 1, 1),
            ("f32-tiles-lerc.tif", [16, 16], 1, 4),
            ("lossy-lerc.tif", [16, 16], 1, 4),
            ("i32-strips-lerc.tif", [37, 23], 1, 4),
            ("bands-lerc.tif", [37, 23], 3, 4),
        ] {
            let file = std::fs::read(corpus.join(name)).unwrap();
            let begin = file.windows(6).position(|window| window == b"Lerc2 ").unwrap();
            let length = u32::from_le_bytes(file[begin + 34..begin + 38].try_into().unwrap()) as usize;
            let blob = &file[begin..begin + length];
            let right = unpack(blob, size, bands, bytes).unwrap();
            for n in 14..blob.len() {
                for flip in [1u8, 0x40, 0xff] {
                    let mut blob = blob.to_vec();
                    blob[n] ^= flip;
                    let sum = fletcher(&blob[14..]);
                    blob[10..14].copy_from_slice(&sum.to_le_bytes());
                    match unpack(&blob, size, bands, bytes) {
                        Ok(samples) => {
                            assert!(samples.len() <= right.len());
                            read += 1;
                        }
                        Err(why) => {
                            assert!(why.contains("LERC"), "{why}");
                            refused += 1;
                        }
                    }
                }
            }
        }
        assert!(read > 500 && refused > 100, "{read} read, {refused} refused");
    }

    #[test]
    fn what_is_no_blob_is_a_sentence() {
        for bytes in [&b""[..], b"Lerc2 ", b"CntZImage ", b"Lerc2 \x04\0\0\0\0\0\0\0"] {
            assert!(unpack(bytes, [4, 4], 1, 4).unwrap_err().contains("LERC"));
        }
    }
}
