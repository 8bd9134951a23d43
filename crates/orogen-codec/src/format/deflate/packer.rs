//! A deflate stream and the checksum that containers store after it.

use std::io::{self, Write};

use crc32fast::Hasher;

use super::stream::{Deflate, Wrap};

/// Compression level.
const LEVEL: u8 = 6;

/// A writer that compresses the bytes written to it.
pub struct Packer<'a> {
    out: &'a mut dyn Write,
    stream: Deflate,
    checksum: Hasher,
    length: u64,
}

impl<'a> Packer<'a> {
    /// A writer that compresses to raw deflate data in `out`.
    pub fn new(out: &'a mut dyn Write) -> Packer<'a> {
        Packer { out, stream: Deflate::new(Wrap::None, LEVEL), checksum: Hasher::new(), length: 0 }
    }

    /// Writes the remaining data. Returns the underlying writer, and the CRC-32 and the length of the uncompressed
    /// data.
    ///
    /// Fails if the underlying writer fails.
    pub fn finish(self) -> io::Result<(&'a mut dyn Write, u32, u64)> {
        self.stream.finish(self.out)?;
        Ok((self.out, self.checksum.finalize(), self.length))
    }
}

impl Write for Packer<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.stream.write(self.out, bytes)?;
        self.checksum.update(bytes);
        self.length += bytes.len() as u64;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}
