//! Gzip (RFC 1952): one member, written as a stream.

use std::io::{self, Write};

use crc32fast::Hasher;
use miniz_oxide::deflate::core::{CompressorOxide, create_comp_flags_from_zip_params};
use miniz_oxide::deflate::stream::deflate;
use miniz_oxide::{DataFormat, MZError, MZFlush, MZStatus};

/// Level of compression.
const LEVEL: i32 = 6;

/// Bytes that are compressed at once.
const PIECE: usize = 64 << 10;

/// A writer that compresses what is written to it.
pub struct Gzip<'a> {
    out: &'a mut dyn Write,
    compressor: Box<CompressorOxide>,
    piece: Vec<u8>,
    checksum: Hasher,
    length: u32,
}

impl<'a> Gzip<'a> {
    /// Writes the header. It has no time and no file name, so equal data give equal files.
    ///
    /// Fails if `out` fails.
    pub fn new(out: &'a mut dyn Write) -> io::Result<Gzip<'a>> {
        out.write_all(&[0x1f, 0x8b, 8, 0, 0, 0, 0, 0, 0, 255])?;
        let mut compressor = CompressorOxide::new(create_comp_flags_from_zip_params(LEVEL, -15, 0));
        compressor.set_format_and_level(DataFormat::Raw, LEVEL as u8);
        Ok(Gzip { out, compressor: Box::new(compressor), piece: vec![0; PIECE], checksum: Hasher::new(), length: 0 })
    }

    /// Writes the rest and the checksum.
    ///
    /// Fails if the writer below fails.
    pub fn finish(mut self) -> io::Result<()> {
        while !self.step(&[], MZFlush::Finish)?.1 {}
        self.out.write_all(&self.checksum.clone().finalize().to_le_bytes())?;
        self.out.write_all(&self.length.to_le_bytes())
    }

    /// Compresses a part of `bytes`; returns how many bytes it took, and whether the stream has ended.
    fn step(&mut self, bytes: &[u8], flush: MZFlush) -> io::Result<(usize, bool)> {
        let done = deflate(&mut self.compressor, bytes, &mut self.piece, flush);
        let is_ended = match done.status {
            Ok(status) => status == MZStatus::StreamEnd,
            // There was nothing to do.
            Err(MZError::Buf) => false,
            Err(error) => return Err(io::Error::other(format!("deflate: {error:?}"))),
        };
        self.out.write_all(&self.piece[..done.bytes_written])?;
        Ok((done.bytes_consumed, is_ended))
    }
}

impl Write for Gzip<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let bytes = &bytes[..bytes.len().min(PIECE)];
        let (taken, _) = self.step(bytes, MZFlush::None)?;
        self.checksum.update(&bytes[..taken]);
        self.length = self.length.wrapping_add(taken as u32);
        Ok(taken)
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
