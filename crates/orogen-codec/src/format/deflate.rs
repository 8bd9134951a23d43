//! Deflate (RFC 1950, RFC 1951) for heights in GeoTIFF and OpenEXR.
//!
//! In a GeoTIFF a row of a tile is stored as planes: all highest bytes, then all second highest, and so on. For heights
//! the two lower planes are mostly noise. A general compressor spends most of its time searching for repeats in them,
//! and mixes their codes with those of the upper planes. Here each plane of each row is classified separately. Noise is
//! *stored* without coding. Other planes are Huffman coded in separate blocks, with literals, runs of one byte, and
//! copies of the same plane in the row above. This is several times as fast, and the result is usually smaller. Other
//! formats mix the bytes of a sample in other ways; for them a plane is simply a piece of the bytes.
//!
//! Bytes with little noise (integer metres, masks, labels, level ground) also repeat at other distances, so a general
//! compressor is used for them.

mod matches;
pub mod packer;
pub mod stream;

use matches::Matches;
use miniz_oxide::deflate::compress_to_vec_zlib;

/// Level of the general compressor. Higher levels take up to eight times as long and save only 1 %.
const LEVEL: u8 = 3;

/// Maximum length of a match in deflate.
const LONGEST: usize = 258;

/// Minimum length of a match in deflate.
const SHORTEST: usize = 3;

/// Numbers of symbols: literals and lengths, distances, and code lengths.
const LITERALS: usize = 286;
const DISTANCES: usize = 30;
const LENGTHS: usize = 19;

/// Maximum number of tokens in a block.
const BLOCK: usize = 1 << 15;

/// Compresses rows of planes of `side` bytes, with four planes per row, to a zlib stream. The last plane may be
/// shorter.
#[must_use]
pub fn pack(rows: &[u8], side: usize) -> Vec<u8> {
    let logarithms = Logarithms::new(side);
    let planes: Vec<&[u8]> = rows.chunks(side).collect();
    let noise: Vec<bool> = planes.iter().map(|plane| logarithms.is_noise(plane)).collect();
    // Fewer than a quarter of the planes are noise.
    if 4 * noise.iter().filter(|noise| **noise).count() < planes.len() || 4 * side > 32768 {
        return compress_to_vec_zlib(rows, LEVEL);
    }
    let is_repeated = |at: usize| at >= 4 && planes[at] == planes[at - 4];
    let mut packer = Packer::new();
    let mut at = 0;
    while at < planes.len() {
        if is_repeated(at) {
            packer.repeat(side, 4 * side);
            at += 1;
        } else if noise[at] {
            let first = at;
            while at < planes.len() && noise[at] && !is_repeated(at) {
                at += 1;
            }
            packer.store(&rows[first * side..rows.len().min(at * side)]);
        } else {
            packer.runs(planes[at]);
            at += 1;
        }
        if packer.tokens.len() > BLOCK - side {
            packer.block();
        }
    }
    packer.finish(rows)
}

/// Compresses bytes with mixed planes to a zlib stream, in pieces of `side` bytes (OpenEXR). Most bytes look like
/// noise, but if one of the planes is not noise, sequences repeat. Pieces are coded with such matches where that saves
/// enough, and stored otherwise.
#[must_use]
pub fn pack_mixed(bytes: &[u8], side: usize) -> Vec<u8> {
    let logarithms = Logarithms::new(side);
    // A quarter of the pieces is tested.
    let noise: Vec<bool> = bytes.chunks(side).step_by(4).map(|piece| logarithms.is_noise(piece)).collect();
    if 4 * noise.iter().filter(|noise| **noise).count() < noise.len() {
        return compress_to_vec_zlib(bytes, LEVEL);
    }
    let (mut packer, mut matches, mut misses) = (Packer::new(), Matches::new(), 0);
    for k in 0..bytes.len().div_ceil(side) {
        let piece = k * side..((k + 1) * side).min(bytes.len());
        // If nothing repeats, only some of the pieces are tried.
        let is_tried = misses < 2 || k % 4 == 0;
        if is_tried && matches.code(bytes, piece.clone(), &mut packer) {
            misses = 0;
        } else {
            misses += 1;
            packer.store(&bytes[piece]);
        }
        if packer.tokens.len() > BLOCK - side {
            packer.block();
        }
    }
    packer.finish(bytes)
}

/// n log2 n for all possible counts.
struct Logarithms(Vec<f64>);

impl Logarithms {
    fn new(side: usize) -> Logarithms {
        Logarithms((0..=side).map(|n| if n > 0 { n as f64 * libm::log2(n as f64) } else { 0.0 }).collect())
    }

    /// Whether entropy coding would save less than a sixteenth. The estimate is corrected, because the entropy of few
    /// bytes is underestimated.
    fn is_noise(&self, plane: &[u8]) -> bool {
        let mut counts = [0u16; 256];
        for byte in plane {
            counts[usize::from(*byte)] += 1;
        }
        let n = plane.len() as f64;
        let spread: f64 = counts.iter().map(|count| self.0[usize::from(*count)]).sum();
        // The correction of Miller and Madow for the entropy of small samples.
        let kinds = counts.iter().filter(|count| **count > 0).count() as f64;
        let bits = libm::log2(n) - spread / n + (kinds - 1.0) * 0.72 / n;
        bits > 7.5
    }
}

/// A literal byte, or a match: a length and a distance.
#[derive(Clone, Copy)]
enum Token {
    Byte(u8),
    Run { length: u16, back: u16 },
}

struct Packer {
    out: Vec<u8>,
    /// Bits of an incomplete byte, with the first bit lowest, and the number of these bits.
    bits: u64,
    count: u32,
    /// Tokens of the next block.
    tokens: Vec<Token>,
}

impl Packer {
    /// A stream that has only its header.
    fn new() -> Packer {
        Packer { out: vec![0x78, 0x01], bits: 0, count: 0, tokens: Vec::with_capacity(BLOCK) }
    }

    /// Adds the bytes of a plane, and codes runs of equal bytes as matches.
    fn runs(&mut self, plane: &[u8]) {
        let mut at = 0;
        while at < plane.len() {
            let byte = plane[at];
            self.tokens.push(Token::Byte(byte));
            at += 1;
            let mut same = plane[at..].iter().take_while(|next| **next == byte).count();
            // Shorter runs of frequent bytes take fewer bits as literals.
            if same < 2 * SHORTEST {
                same = 0;
            }
            self.repeat(same, 1);
            at += same;
        }
    }

    /// Adds matches for `length` bytes at the distance `back`.
    fn repeat(&mut self, mut length: usize, back: usize) {
        while length >= SHORTEST {
            // The rest must not be shorter than the minimum length of a match.
            let take = match length {
                n if n <= LONGEST => n,
                n if n < LONGEST + SHORTEST => n - SHORTEST,
                _ => LONGEST,
            };
            self.tokens.push(Token::Run { length: take as u16, back: back as u16 });
            length -= take;
        }
    }

    /// Writes bytes without coding.
    fn store(&mut self, bytes: &[u8]) {
        self.block();
        for piece in bytes.chunks(65535) {
            self.put(0, 3);
            self.put(0, (8 - self.count % 8) % 8);
            self.drain();
            let length = piece.len() as u16;
            self.out.extend(length.to_le_bytes());
            self.out.extend((!length).to_le_bytes());
            self.out.extend_from_slice(piece);
        }
    }

    /// Writes a block of the pending tokens, if there are any.
    fn block(&mut self) {
        if self.tokens.is_empty() {
            return;
        }
        let tokens = std::mem::take(&mut self.tokens);
        let (mut literals, mut distances) = ([0u32; LITERALS], [0u32; DISTANCES]);
        for token in &tokens {
            match *token {
                Token::Byte(byte) => literals[usize::from(byte)] += 1,
                Token::Run { length, back } => {
                    literals[length_code(length).0] += 1;
                    distances[distance_code(back).0] += 1;
                }
            }
        }
        literals[256] = 1;
        let literals: [Code; LITERALS] = codes(&literals, 15);
        let distances: [Code; DISTANCES] = codes(&distances, 15);
        // Not the last block; dynamic codes.
        self.put(0b100, 3);
        self.head(&literals, &distances);
        for token in &tokens {
            match *token {
                Token::Byte(byte) => self.code(literals[usize::from(byte)]),
                Token::Run { length, back } => {
                    let (symbol, extra, bits) = length_code(length);
                    self.code(literals[symbol]);
                    self.put(extra, bits);
                    let (symbol, extra, bits) = distance_code(back);
                    self.code(distances[symbol]);
                    self.put(extra, bits);
                }
            }
        }
        self.code(literals[256]);
        self.tokens = tokens;
        self.tokens.clear();
    }

    /// Writes the code lengths, which are also Huffman coded.
    fn head(&mut self, literals: &[Code; LITERALS], distances: &[Code; DISTANCES]) {
        /// The order of the code length codes in RFC 1951.
        const ORDER: [usize; LENGTHS] = [16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15];
        let used = |codes: &[Code], least: usize| {
            codes.iter().rposition(|code| code.length > 0).map_or(least, |last| (last + 1).max(least))
        };
        let (many, far) = (used(literals, 257), used(distances, 1));
        let lengths: Vec<u8> = (literals[..many].iter().chain(&distances[..far])).map(|code| code.length).collect();
        // Symbols with their extra bits: 16 repeats the last length, 17 and 18 are runs of zeros.
        let mut symbols: Vec<(usize, u32, u32)> = Vec::new();
        let mut at = 0;
        while at < lengths.len() {
            let length = lengths[at];
            let same = lengths[at..].iter().take_while(|next| **next == length).count();
            match (length, same) {
                (0, 11..) => {
                    symbols.push((18, same.min(138) as u32 - 11, 7));
                    at += same.min(138);
                }
                (0, 3..) => {
                    symbols.push((17, same as u32 - 3, 3));
                    at += same;
                }
                (1.., 4..) => {
                    symbols.push((usize::from(length), 0, 0));
                    symbols.push((16, (same - 1).min(6) as u32 - 3, 2));
                    at += 1 + (same - 1).min(6);
                }
                _ => {
                    symbols.push((usize::from(length), 0, 0));
                    at += 1;
                }
            }
        }
        let mut counts = [0u32; LENGTHS];
        symbols.iter().for_each(|(symbol, ..)| counts[*symbol] += 1);
        let codes: [Code; LENGTHS] = codes(&counts, 7);
        let sent = ORDER.iter().rposition(|symbol| codes[*symbol].length > 0).map_or(4, |last| (last + 1).max(4));
        self.put(many as u32 - 257, 5);
        self.put(far as u32 - 1, 5);
        self.put(sent as u32 - 4, 4);
        ORDER[..sent].iter().for_each(|symbol| self.put(u32::from(codes[*symbol].length), 3));
        for (symbol, extra, bits) in symbols {
            self.code(codes[symbol]);
            self.put(extra, bits);
        }
    }

    fn code(&mut self, code: Code) {
        self.put(u32::from(code.bits), u32::from(code.length));
    }

    fn put(&mut self, bits: u32, count: u32) {
        self.bits |= u64::from(bits) << self.count;
        self.count += count;
        if self.count >= 32 {
            self.out.extend((self.bits as u32).to_le_bytes());
            self.bits >>= 32;
            self.count -= 32;
        }
    }

    /// Moves the complete bytes to the output.
    fn drain(&mut self) {
        while self.count >= 8 {
            self.out.push(self.bits as u8);
            self.bits >>= 8;
            self.count -= 8;
        }
    }

    fn finish(mut self, rows: &[u8]) -> Vec<u8> {
        self.block();
        // The last block has fixed codes and only the end symbol.
        self.put(0b011, 3);
        self.put(0, 7);
        self.put(0, (8 - self.count % 8) % 8);
        self.drain();
        self.out.extend(adler(rows).to_be_bytes());
        self.out
    }
}

/// The bits of a symbol in writing order, and their number; 0 for a symbol that does not occur.
#[derive(Clone, Copy, Default)]
struct Code {
    bits: u16,
    length: u8,
}

/// The codes of symbols with these counts, none longer than `most`.
///
/// Huffman code lengths are computed with the in-place method of Moffat and Katajainen on the sorted counts. Lengths
/// that are too long are cut, and others are increased until the code is valid again.
fn codes<const N: usize>(counts: &[u32; N], most: u8) -> [Code; N] {
    let mut symbols: Vec<(u32, usize)> =
        counts.iter().enumerate().filter(|(_, count)| **count > 0).map(|(symbol, count)| (*count, symbol)).collect();
    symbols.sort_unstable();
    let mut codes = [Code::default(); N];
    // A tree needs at least two leaves, so a second symbol is added.
    for spare in [0, 1] {
        if symbols.len() < 2 && !symbols.iter().any(|(_, symbol)| *symbol == spare) {
            symbols.insert(0, (0, spare));
        }
    }
    let mut depths = depths(&symbols.iter().map(|(count, _)| *count).collect::<Vec<u32>>());
    limit(&mut depths, most);
    // Canonical codes: by length, then by symbol.
    let mut by_length = [0u16; 16];
    depths.iter().for_each(|depth| by_length[usize::from(*depth)] += 1);
    let mut next = [0u16; 16];
    for length in 1..16 {
        next[length] = (next[length - 1] + if length > 1 { by_length[length - 1] } else { 0 }) << 1;
    }
    for ((_, symbol), depth) in symbols.iter().zip(&depths) {
        codes[*symbol].length = *depth;
    }
    for code in codes.iter_mut().filter(|code| code.length > 0) {
        let bits = &mut next[usize::from(code.length)];
        code.bits = bits.reverse_bits() >> (16 - code.length);
        *bits += 1;
    }
    codes
}

/// The depth of each count in the Huffman tree. Counts are sorted, the smallest first, and there are at least two.
fn depths(counts: &[u32]) -> Vec<u8> {
    let n = counts.len();
    // Nodes are created in order of weight, from two queues: one of leaves and one of pairs.
    let mut weights: Vec<u64> = counts.iter().map(|count| u64::from(*count)).collect();
    let mut parents = vec![0usize; 2 * n - 1];
    let (mut leaf, mut pair) = (0, n);
    for made in n..2 * n - 1 {
        let mut weight = 0;
        for _ in 0..2 {
            let take = if leaf < n && (pair >= made || weights[leaf] <= weights[pair]) { &mut leaf } else { &mut pair };
            weight += weights[*take];
            parents[*take] = made;
            *take += 1;
        }
        weights.push(weight);
    }
    let mut depths = vec![0u8; 2 * n - 1];
    for node in (0..2 * n - 2).rev() {
        depths[node] = depths[parents[node]].saturating_add(1);
    }
    depths.truncate(n);
    depths
}

/// Limits depths to `most` and keeps the code valid. The deepest come first.
fn limit(depths: &mut [u8], most: u8) {
    let whole = 1u32 << most;
    depths.iter_mut().for_each(|depth| *depth = (*depth).min(most));
    let mut taken: u32 = depths.iter().map(|depth| whole >> depth).sum();
    // The rarest symbols whose lengths may still grow come first, because they cost the least.
    while taken > whole {
        let Some(depth) = depths.iter_mut().filter(|depth| **depth < most).max_by_key(|depth| **depth) else { return };
        taken -= whole >> (*depth + 1);
        *depth += 1;
    }
    // The remaining room is given to the most frequent symbols that can use it, because decoders require a complete
    // code.
    while taken < whole {
        let left = whole - taken;
        let Some(depth) = depths.iter_mut().rev().find(|depth| **depth > 1 && whole >> **depth <= left) else { return };
        taken += whole >> *depth;
        *depth -= 1;
    }
}

/// The symbol of a length, with its extra bits.
fn length_code(length: u16) -> (usize, u32, u32) {
    match length {
        258 => (285, 0, 0),
        3..=10 => (254 + usize::from(length), 0, 0),
        _ => {
            let rest = u32::from(length) - 3;
            let bits = 29 - rest.leading_zeros();
            let symbol = 257 + 4 * (bits as usize + 1) + (rest >> bits) as usize - 4;
            (symbol, rest & ((1 << bits) - 1), bits)
        }
    }
}

/// The symbol of a distance, with its extra bits.
fn distance_code(back: u16) -> (usize, u32, u32) {
    let rest = u32::from(back) - 1;
    match rest {
        0..=3 => (rest as usize, 0, 0),
        _ => {
            let bits = 30 - rest.leading_zeros();
            (2 * (bits as usize + 1) + (rest >> bits) as usize - 2, rest & ((1 << bits) - 1), bits)
        }
    }
}

/// Adler-32 checksum (RFC 1950).
fn adler(bytes: &[u8]) -> u32 {
    let (mut a, mut b) = (1u32, 0u32);
    // The largest piece whose sums fit in 32 bits.
    for piece in bytes.chunks(5552) {
        // b grows by the value of a at each byte: it is the sum of the bytes, each weighted by the number of bytes from
        // it to the end.
        let n = piece.len() as u32;
        let sum: u32 = piece.iter().map(|byte| u32::from(*byte)).sum();
        let weighed: u32 =
            piece.iter().enumerate().map(|(k, byte)| (n - k as u32) * u32::from(*byte)).fold(0, u32::wrapping_add);
        debug_assert!(u64::from(n) * u64::from(n + 1) / 2 * 255 <= u64::from(u32::MAX));
        b = (b + n * a + weighed % 65521) % 65521;
        a = (a + sum) % 65521;
    }
    b << 16 | a
}

#[cfg(test)]
mod tests {
    use super::*;
    use miniz_oxide::inflate::decompress_to_vec_zlib;

    /// Random bytes (splitmix64).
    fn hashed(k: usize) -> u8 {
        let mut z = (k as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) as u8
    }

    #[test]
    fn every_kind_of_rows_comes_back() {
        for side in [16, 48, 512, 1024, 8192] {
            for kind in 0..7usize {
                let plane = |row: usize, plane: usize| -> Vec<u8> {
                    (0..side)
                        .map(|i| {
                            let k = (row * 4 + plane) * side + i;
                            match (kind, plane) {
                                // Noise; heights; level ground; repeated rows; runs of all lengths; one noisy byte
                                // plane; skewed bytes.
                                (0, _) | (1 | 4 | 6, 2..) | (5, 3) => hashed(k),
                                (1, 0) | (2, _) | (5, _) => 0,
                                (1, 1) => hashed(k) & 3,
                                (3, _) => hashed(plane * side + i),
                                (4, _) => (i / (1 + row * 7)) as u8,
                                _ => hashed(k).leading_zeros() as u8,
                            }
                        })
                        .collect()
                };
                let rows: Vec<u8> = (0..40).flat_map(|row| (0..4).flat_map(move |p| plane(row, p))).collect();
                for cut in [1, side / 2, side + 3] {
                    let rows = &rows[..rows.len() - cut];
                    for packed in [pack(rows, side), pack_mixed(rows, side)] {
                        assert!(decompress_to_vec_zlib(&packed).unwrap() == rows, "{kind} of {side} less {cut}");
                    }
                }
                let packed = pack(&rows, side);
                assert!(decompress_to_vec_zlib(&packed).unwrap() == rows, "{kind} of {side}");
                assert!(packed.len() < rows.len() + rows.len() / 50 + 100, "{kind} of {side}: {}", packed.len());
            }
        }
    }

    #[test]
    fn heights_are_no_larger_than_the_general_packer_makes_them() {
        let side = 512;
        let rows: Vec<u8> = (0..side)
            .flat_map(|row| {
                (0..4 * side).map(move |i| match i / side {
                    0 => 0,
                    1 => hashed(row * side + i) & hashed(row * side + i + 99_991) & 3,
                    _ => hashed(row * 4 * side + i),
                })
            })
            .collect();
        let (ours, theirs) = (pack(&rows, side).len(), compress_to_vec_zlib(&rows, 6).len());
        assert!(ours * 100 < theirs * 102, "{ours} beside {theirs}");
    }

    #[test]
    fn codes_are_whole_and_short_enough() {
        // Fibonacci numbers yield the deepest trees.
        let mut counts = [0u32; 30];
        let (mut a, mut b) = (1, 1);
        for count in &mut counts {
            *count = a;
            (a, b) = (b, a + b);
        }
        for most in [5, 7, 15] {
            let codes = codes(&counts, most);
            assert!(codes.iter().all(|code| (1..=most).contains(&code.length)));
            let taken: u32 = codes.iter().map(|code| 1u32 << (most - code.length)).sum();
            assert_eq!(taken, 1 << most, "{most}");
        }
        let mut one = [0u32; 30];
        one[7] = 3;
        assert_eq!(codes(&one, 15).iter().filter(|code| code.length == 1).count(), 2);
    }

    #[test]
    fn lengths_and_distances_are_those_of_the_format() {
        for (length, symbol, extra, bits) in [
            (3, 257, 0, 0),
            (10, 264, 0, 0),
            (11, 265, 0, 1),
            (12, 265, 1, 1),
            (13, 266, 0, 1),
            (19, 269, 0, 2),
            (257, 284, 30, 5),
            (258, 285, 0, 0),
        ] {
            assert_eq!(length_code(length), (symbol, extra, bits), "{length}");
        }
        for (back, symbol, extra, bits) in [
            (1, 0, 0, 0),
            (4, 3, 0, 0),
            (5, 4, 0, 1),
            (7, 5, 0, 1),
            (2048, 21, 511, 9),
            (2049, 22, 0, 10),
            (32768, 29, 8191, 13),
        ] {
            assert_eq!(distance_code(back), (symbol, extra, bits), "{back}");
        }
        assert_eq!(adler(b"Wikipedia"), 0x11e6_0398);
    }

    #[test]
    fn a_plane_that_changes_slowly_is_found_among_noise() {
        // The two upper bytes of a height in OpenEXR's order: one almost constant, one with small steps, and their
        // differences.
        let upper =
            |k: usize| if k.is_multiple_of(2) { 67 } else { (k / 2 * 5 + usize::from(hashed(k / 2) & 3)) as u8 };
        let bytes: Vec<u8> = (1..100_000).map(|k| upper(k).wrapping_sub(upper(k - 1)).wrapping_add(128)).collect();
        let packed = pack_mixed(&bytes, 4096);
        assert!(decompress_to_vec_zlib(&packed).unwrap() == bytes);
        assert!(10 * packed.len() < 9 * bytes.len(), "{} of {}", packed.len(), bytes.len());
        let noise: Vec<u8> = (0..100_000).map(hashed).collect();
        assert!(pack_mixed(&noise, 4096).len() < noise.len() + 1000);
    }
}
