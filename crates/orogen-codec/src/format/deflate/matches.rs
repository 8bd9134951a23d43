//! Matches within 32 KiB, for bytes for which entropy coding saves nothing. For each position only the latest earlier
//! position with the same three bytes is tested.

use super::{Packer, Token};

/// Maximum length of a match in deflate, and size of its window.
const LONGEST: usize = 258;
const WINDOW: usize = 32768;

/// Number of bits of a hash.
const HASH: u32 = 15;

/// Approximate number of bits of a match, without its distance.
const MATCH: usize = 7;

/// The latest positions of sequences of three bytes.
pub(super) struct Matches {
    /// For each hash, the position after the latest sequence; 0 if there is none.
    seen: Vec<u32>,
    tokens: Vec<Token>,
}

impl Matches {
    /// An empty table.
    pub fn new() -> Matches {
        Matches { seen: vec![0; 1 << HASH], tokens: Vec::new() }
    }

    /// Codes a piece of `bytes` if that saves at least a twentieth, and returns whether it did. `bytes` is the whole
    /// input, because matches may refer to any earlier block.
    pub fn code(&mut self, bytes: &[u8], piece: std::ops::Range<usize>, packer: &mut Packer) -> bool {
        self.tokens.clear();
        let (mut at, mut bits) = (piece.start, 0);
        while at < piece.end {
            let Some((length, back)) = self.latest(bytes, at, piece.end) else {
                self.tokens.push(Token::Byte(bytes[at]));
                at += 1;
                bits += 8;
                continue;
            };
            self.tokens.push(Token::Run { length: length as u16, back: back as u16 });
            at += length;
            bits += MATCH + back.ilog2() as usize;
        }
        let saves = 20 * bits < 19 * 8 * piece.len();
        if saves {
            packer.tokens.append(&mut self.tokens);
        }
        saves
    }

    /// The length and the distance of the match at the latest position with the same start. Records the current
    /// position.
    #[inline(always)]
    fn latest(&mut self, bytes: &[u8], at: usize, end: usize) -> Option<(usize, usize)> {
        let four = u32::from_le_bytes(*bytes.get(at..)?.first_chunk::<4>()?);
        let hash = ((four << 8).wrapping_mul(0x9E37_79B1) >> (32 - HASH)) as usize;
        let before = std::mem::replace(&mut self.seen[hash], at as u32 + 1).checked_sub(1)? as usize;
        let back = at - before;
        // Matches end at the end of the piece, because the next piece may be stored.
        let most = LONGEST.min(end - at);
        if back > WINDOW || most < 3 {
            return None;
        }
        // The first byte is the lowest, so the trailing zero bits give the number of equal bytes.
        let other = u32::from_le_bytes(*bytes.get(before..)?.first_chunk::<4>()?);
        let differ = four ^ other;
        match differ.trailing_zeros() {
            0..24 => None,
            24..32 => Some((3, back)),
            _ => {
                let (one, other) = (&bytes[before..before + most], &bytes[at..at + most]);
                Some((one.iter().zip(other).take_while(|(one, other)| one == other).count(), back))
            }
        }
    }
}
