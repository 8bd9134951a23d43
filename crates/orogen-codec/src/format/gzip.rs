//! Gzip (RFC 1952) with one member, written as a stream.

use std::io::{self, Write};

use super::deflate::packer::Packer;

/// Writes the header, and returns the writer for the data. The header has no time and no file name, so equal data give
/// equal files.
///
/// Fails if `out` fails.
pub fn start(out: &mut dyn Write) -> io::Result<Packer<'_>> {
    out.write_all(&[0x1f, 0x8b, 8, 0, 0, 0, 0, 0, 0, 255])?;
    Ok(Packer::new(out))
}

/// Writes the remaining data, the checksum and the length.
///
/// Fails if the underlying writer fails.
pub fn finish(packer: Packer) -> io::Result<()> {
    let (out, checksum, length) = packer.finish()?;
    out.write_all(&checksum.to_le_bytes())?;
    out.write_all(&(length as u32).to_le_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_packed_is_unpacked_again() {
        for length in [0usize, 1, 100, 300_000] {
            let bytes: Vec<u8> = (0..length).map(|k| ((k * k) >> 9) as u8).collect();
            let mut packed = Vec::new();
            let mut gzip = start(&mut packed).unwrap();
            gzip.write_all(&bytes).unwrap();
            finish(gzip).unwrap();
            let [head, tail] = [&packed[..10], &packed[packed.len() - 8..]];
            assert_eq!(head[..3], [0x1f, 0x8b, 8]);
            let body = miniz_oxide::inflate::decompress_to_vec(&packed[10..packed.len() - 8]).unwrap();
            assert!(body == bytes, "{length}");
            assert_eq!(tail[..4], crc32fast::hash(&bytes).to_le_bytes());
            assert_eq!(tail[4..], (length as u32).to_le_bytes());
        }
    }
}
