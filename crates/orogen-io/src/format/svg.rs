//! Helpers for SVG files that every reader can open, whatever their size.
//!
//! XML readers have limits. libxml2, which librsvg uses, rejects attributes of more than 10 million characters, and
//! also 10 million characters of elements if its buffer could not be freed between them. Writers therefore make
//! elements of bounded length, and padding follows each long one.

use std::io::{self, Write};

/// Number of characters of a path after which a new one starts.
pub const MAX_PATH: usize = 1 << 16;

/// Maximum number of points of a line; a longer line is written as several.
const MAX_POINTS: usize = 1 << 11;

/// Number of spaces after a long element. libxml2 frees its buffer when little of it is left to read. This rarely
/// happens at the end of an element longer than its read size, but always happens within this many spaces.
const PADDING: usize = 1 << 13;

/// Writes padding, for use after an element longer than [`MAX_PATH`].
///
/// # Errors
/// Errors of `out`.
pub fn pad(out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "{:PADDING$}", "")
}

/// Splits a line into pieces of bounded length; each starts with the last point of the previous one.
pub fn pieces<T>(line: &[T]) -> impl Iterator<Item = &[T]> {
    let last = line.len().saturating_sub(1).max(1);
    (0..last).step_by(MAX_POINTS).map(move |from| &line[from..(from + MAX_POINTS + 1).min(line.len())])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_meet_and_leave_nothing_out() {
        for count in [0, 1, 2, 2048, 2049, 2050, 10_000] {
            let line: Vec<usize> = (0..count).collect();
            let pieces: Vec<&[usize]> = pieces(&line).collect();
            let segments: Vec<[usize; 2]> =
                pieces.iter().flat_map(|piece| piece.windows(2).map(|pair| [pair[0], pair[1]])).collect();
            assert_eq!(segments, line.windows(2).map(|pair| [pair[0], pair[1]]).collect::<Vec<_>>(), "{count}");
            assert!(pieces.iter().all(|piece| piece.len() <= 2049));
        }
    }
}
