//! Changes of inputs that depend on a seed alone.

use orogen_grid::random::Random;

/// Numbers at limits, as bytes.
const BYTES: [u8; 12] = [0, 1, 0x7f, 0x80, 0xff, b'\n', b'"', b'-', b'0', b'9', b'[', b'\\'];

/// Numbers at limits, as four bytes.
const WORDS: [u32; 8] = [0, 1, 0xffff, 0x10000, 0x7fff_ffff, 0x8000_0000, 0xffff_fffe, 0xffff_ffff];

/// Words of texts at limits.
const TEXTS: [&str; 10] =
    ["-1", "0", "1e999", "NaN", "18446744073709551616", "1e-320", "[[[[", "\u{fffd}", "---\n", "\""];

/// One of the files with one to four changes.
pub fn changed(corpus: &[Vec<u8>], which: usize, seed: u64) -> Vec<u8> {
    let mut random = Random::of_state(seed);
    let mut bytes = corpus[which].clone();
    for _ in 0..=random.below(4) {
        change(&mut bytes, corpus, &mut random);
    }
    bytes
}

/// Changes something.
fn change(bytes: &mut Vec<u8>, corpus: &[Vec<u8>], random: &mut Random) {
    let at = random.below(bytes.len() + 1);
    let end = (at + 1 + random.below(8)).min(bytes.len());
    match random.below(10) {
        // Bits are flipped.
        0 | 1 => {
            if let Some(byte) = bytes.get_mut(at) {
                *byte ^= 1 << random.below(8);
            }
        }
        2 => {
            if let Some(byte) = bytes.get_mut(at) {
                *byte = BYTES[random.below(BYTES.len())];
            }
        }
        3 => {
            let word = WORDS[random.below(WORDS.len())];
            let word = if random.below(2) == 0 { word.to_le_bytes() } else { word.to_be_bytes() };
            if let Some(place) = bytes.get_mut(at..at + 4) {
                place.copy_from_slice(&word);
            }
        }
        // A number of a text takes other digits.
        4 => {
            if let Some(digit) = bytes[at..].iter_mut().find(|byte| byte.is_ascii_digit()) {
                *digit = b'0' + random.below(10) as u8;
            }
        }
        // Bytes are inserted, instead of others or between them.
        5 => drop(bytes.splice(at..at, (0..=random.below(6)).map(|_| random.draw() as u8).collect::<Vec<_>>())),
        6 => drop(bytes.splice(at..end, TEXTS[random.below(TEXTS.len())].bytes())),
        // Bytes are removed, or come twice.
        7 => drop(bytes.drain(at..end)),
        8 => {
            let (from, to) = (random.below(bytes.len() + 1).min(at), at);
            let again = bytes[from..to].iter().copied().take(64).collect::<Vec<_>>();
            drop(bytes.splice(at..at, again));
        }
        // The rest is lost, or that of another file follows.
        _ => {
            bytes.truncate(at);
            if random.below(3) > 0 {
                let other = &corpus[random.below(corpus.len())];
                bytes.extend_from_slice(&other[random.below(other.len() + 1)..]);
            }
        }
    }
}
