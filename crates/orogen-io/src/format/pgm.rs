//! PGM (Netpbm, `P5`): an uncompressed grayscale picture of 8 or 16 bits.
//!
//! A text header (size and maximum level), then the levels, row by row; 16-bit levels are big-endian.

use std::io::{self, Write};

/// Writes the header of a picture whose maximum level is 255 or 65535. `notes` become comments, one line each. All
/// levels must follow, as one byte or as two bytes in big-endian order.
pub fn write_head(out: &mut dyn Write, size: [usize; 2], most: u16, notes: &[String]) -> io::Result<()> {
    writeln!(out, "P5")?;
    for note in notes {
        // A line break would end the comment.
        writeln!(out, "# {}", note.replace(['\n', '\r'], " "))?;
    }
    writeln!(out, "{} {}\n{most}", size[0], size[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_head_is_text() {
        let mut bytes = Vec::new();
        write_head(&mut bytes, [3, 2], 65535, &["a\nb".into()]).unwrap();
        assert_eq!(String::from_utf8(bytes).unwrap(), "P5\n# a b\n3 2\n65535\n");
    }
}
