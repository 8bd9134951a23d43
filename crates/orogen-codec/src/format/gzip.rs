//! Gzip (RFC 1952): one member, written as a stream.

use std::io::{self, Write};

use crc32fast::Hasher;

use super::deflate::stream::{Deflate, Wrap};

/// Level of compression.
const LEVEL: u8 = 6;

/// A writer that compresses what is written to it.
pub struct Gzip<'a> {
    out: &'a mut dyn Write,
    stream: Deflate,
    checksum: Hasher,
    length: u32,
}

impl<'a> Gzip<'a> {
    /// Writes the header. It has no time and no file name, so equal data give equal files.
    ///
    /// Fails if `out` fails.
    pub fn new(out: &'a mut dyn Write) -> io::Result<Gzip<'a>> {
        out.write_all(&[0x1f, 0x8b, 8, 0, 0, 0, 0, 0, 0, 255])?;
        Ok(Gzip { out, stream: Deflate::new(Wrap::None, LEVEL), checksum: Hasher::new(), length: 0 })
    }

    /// Writes the rest and the checksum.
    ///
    /// Fails if the writer below fails.
    pub fn finish(self) -> io::Result<()> {
        self.stream.finish(self.out)?;
        self.out.write_all(&self.checksum.clone().finalize().to_le_bytes())?;
        self.out.write_all(&self.length.to_le_bytes())
    }
}

impl Write for Gzip<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.stream.write(self.out, bytes)?;
        self.checksum.update(bytes);
        self.length = self.length.wrapping_add(bytes.len() as u32);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_packed_is_unpacked_again() {
        for length in [0usize, 1, 100, 300_000] {
            let bytes: Vec<u8> = (0..length).map(|k| ((k * k) >> 9) as u8).collect();
            let mut packed = Vec::new();
            let mut gzip = Gzip::new(&mut packed).unwrap();
            gzip.write_all(&bytes).unwrap();
            gzip.finish().unwrap();
            let [head, tail] = [&packed[..10], &packed[packed.len() - 8..]];
            assert_eq!(head[..3], [0x1f, 0x8b, 8]);
            let body = miniz_oxide::inflate::decompress_to_vec(&packed[10..packed.len() - 8]).unwrap();
            assert!(body == bytes, "{length}");
            assert_eq!(tail[..4], crc32fast::hash(&bytes).to_le_bytes());
            assert_eq!(tail[4..], (length as u32).to_le_bytes());
        }
    }
}
