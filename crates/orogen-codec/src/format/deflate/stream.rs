//! Deflate (RFC 1951) and zlib (RFC 1950) as streams, for any number of bytes in bounded memory.
//!
//! The output does not depend on how the input is divided into pieces.

use std::io::{self, Write};

use miniz_oxide::deflate::core::{CompressorOxide, create_comp_flags_from_zip_params};
use miniz_oxide::deflate::stream::deflate;
use miniz_oxide::inflate::stream::{InflateState, inflate};
use miniz_oxide::{DataFormat, MZError, MZFlush, MZStatus};

/// Maximum number of bytes that are compressed at once.
const PIECE: usize = 64 << 10;

/// Memory of a stream, in bytes.
pub const MEMORY: u64 = 512 << 10;

/// The container of the compressed bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Wrap {
    /// No container: raw deflate.
    None,
    /// A zlib header and checksum.
    Zlib,
}

/// A compressing stream.
pub struct Deflate {
    compressor: Box<CompressorOxide>,
    piece: Vec<u8>,
}

impl Deflate {
    /// A new stream. `level` is 1 (fast) to 9 (small).
    #[must_use]
    pub fn new(wrap: Wrap, level: u8) -> Deflate {
        let (format, bits) = match wrap {
            Wrap::None => (DataFormat::Raw, -15),
            Wrap::Zlib => (DataFormat::Zlib, 15),
        };
        let mut compressor = CompressorOxide::new(create_comp_flags_from_zip_params(i32::from(level), bits, 0));
        compressor.set_format_and_level(format, level);
        Deflate { compressor: Box::new(compressor), piece: vec![0; PIECE] }
    }

    /// Compresses `bytes`, and writes the output that is ready to `out`.
    ///
    /// Fails if `out` fails.
    pub fn write(&mut self, out: &mut dyn Write, mut bytes: &[u8]) -> io::Result<()> {
        while !bytes.is_empty() {
            let (taken, _) = self.step(out, bytes, MZFlush::None)?;
            bytes = &bytes[taken..];
        }
        Ok(())
    }

    /// Writes the remaining output.
    ///
    /// Fails if `out` fails.
    pub fn finish(mut self, out: &mut dyn Write) -> io::Result<()> {
        while !self.step(out, &[], MZFlush::Finish)?.1 {}
        Ok(())
    }

    /// Compresses a part of `bytes`. Returns the number of consumed bytes, and whether the stream has ended.
    fn step(&mut self, out: &mut dyn Write, bytes: &[u8], flush: MZFlush) -> io::Result<(usize, bool)> {
        let done = deflate(&mut self.compressor, bytes, &mut self.piece, flush);
        let is_ended = match done.status {
            Ok(status) => status == MZStatus::StreamEnd,
            // There was nothing to do.
            Err(MZError::Buf) => false,
            Err(error) => return Err(io::Error::other(format!("deflate: {error:?}"))),
        };
        out.write_all(&self.piece[..done.bytes_written])?;
        Ok((done.bytes_consumed, is_ended))
    }
}

/// A stream that decompresses the output of [`Deflate`] with [`Wrap::Zlib`].
pub struct Inflate {
    state: Box<InflateState>,
    /// Compressed bytes; those from `next` on are not decompressed yet.
    packed: Vec<u8>,
    next: usize,
}

impl Default for Inflate {
    fn default() -> Inflate {
        Inflate::new()
    }
}

impl Inflate {
    /// A new stream.
    #[must_use]
    pub fn new() -> Inflate {
        Inflate { state: InflateState::new_boxed(DataFormat::Zlib), packed: Vec::new(), next: 0 }
    }

    /// Fills `bytes` with the next decompressed bytes. `more` provides the next compressed bytes, or none at their end.
    ///
    /// Fails if `more` fails, or if the compressed bytes are damaged or end too early.
    pub fn read(&mut self, bytes: &mut [u8], mut more: impl FnMut(&mut Vec<u8>) -> io::Result<()>) -> io::Result<()> {
        let mut filled = 0;
        while filled < bytes.len() {
            if self.next == self.packed.len() {
                self.packed.clear();
                self.next = 0;
                more(&mut self.packed)?;
            }
            let is_at_end = self.packed.is_empty();
            let done = inflate(&mut self.state, &self.packed[self.next..], &mut bytes[filled..], MZFlush::None);
            self.next += done.bytes_consumed;
            filled += done.bytes_written;
            match done.status {
                // Bytes that were decompressed before may still be in the buffer.
                Ok(_) | Err(MZError::Buf) if done.bytes_written > 0 || !is_at_end => {}
                _ => return Err(io::ErrorKind::UnexpectedEof.into()),
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_packed_in_any_pieces_is_the_same_and_is_unpacked_again() {
        for length in [0usize, 1, 100, 300_000] {
            let bytes: Vec<u8> = (0..length).map(|k| ((k * k) >> 9) as u8).collect();
            let pack = |pieces: usize| {
                let (mut packed, mut stream) = (Vec::new(), Deflate::new(Wrap::Zlib, 6));
                for piece in bytes.chunks(pieces) {
                    stream.write(&mut packed, piece).unwrap();
                }
                stream.finish(&mut packed).unwrap();
                packed
            };
            let packed = pack(1 << 20);
            assert!([1, 7, 999, 70_000].into_iter().all(|pieces| pack(pieces) == packed), "{length}");
            assert!(miniz_oxide::inflate::decompress_to_vec_zlib(&packed).unwrap() == bytes);
            for pieces in [1, 5, 4096, 100_000] {
                let (mut stream, mut parts, mut unpacked) = (Inflate::new(), packed.chunks(pieces), Vec::new());
                let mut more = |to: &mut Vec<u8>| {
                    to.extend(parts.next().unwrap_or_default());
                    Ok(())
                };
                while unpacked.len() < length {
                    let mut part = vec![0; (length - unpacked.len()).min(3 * pieces)];
                    stream.read(&mut part, &mut more).unwrap();
                    unpacked.extend(part);
                }
                assert!(unpacked == bytes, "{length} in {pieces}");
                assert!(stream.read(&mut [0], &mut more).is_err(), "there is no more");
            }
        }
    }

    #[test]
    fn damaged_bytes_are_an_error() {
        let (mut packed, mut stream) = (Vec::new(), Deflate::new(Wrap::Zlib, 6));
        stream.write(&mut packed, &[7; 5000]).unwrap();
        stream.finish(&mut packed).unwrap();
        for cut in 0..packed.len() - 5 {
            let mut parts = packed[..cut].chunks(3);
            let more = |to: &mut Vec<u8>| {
                to.extend(parts.next().unwrap_or_default());
                Ok(())
            };
            assert!(Inflate::new().read(&mut [0; 5000], more).is_err(), "{cut}");
        }
        let damaged = |to: &mut Vec<u8>| {
            to.extend([1, 2, 3]);
            Ok(())
        };
        assert!(Inflate::new().read(&mut [0; 5], damaged).is_err());
    }
}
