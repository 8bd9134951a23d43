//! ZIP archives (APPNOTE 6.3), written as a stream: files compressed with deflate, with their sizes after the data.

use std::io::{self, Write};

use super::deflate::packer::Packer;
use orogen_grid::error::{Error, ErrorKind};

/// Version of the format that readers need.
const VERSION: u16 = 20;

/// Flags: the sizes follow the data, and names are UTF-8.
const FLAGS: u16 = 1 << 3 | 1 << 11;

/// The number of the method deflate.
const DEFLATE: u16 = 8;

/// 1 January 1980, the earliest date in an archive, so that equal data give equal archives.
const DATE: u16 = 1 << 5 | 1;

/// An archive that is being written.
pub struct ZipWriter<'a> {
    out: Counted<'a>,
    /// The directory at the end of the archive, and the number of files in it.
    directory: Vec<u8>,
    files: u16,
}

impl<'a> ZipWriter<'a> {
    /// An archive that is written to `out`.
    pub fn new(out: &'a mut dyn Write) -> ZipWriter<'a> {
        ZipWriter { out: Counted { out, count: 0 }, directory: Vec::new(), files: 0 }
    }

    /// Adds a file.
    ///
    /// # Errors
    /// If `body` or the underlying writer fails, or if the archive would be 4 GiB or larger.
    pub fn file(&mut self, name: &str, body: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
        let start = small(self.out.count)?;
        let length = u16::try_from(name.len()).map_err(|_| io::ErrorKind::InvalidInput)?;
        let common = numbers(&[VERSION, FLAGS, DEFLATE, 0, DATE]);
        self.out.write_all(b"PK\x03\x04")?;
        self.out.write_all(&common)?;
        // The checksum and the sizes are not known yet.
        self.out.write_all(&[0; 12])?;
        self.out.write_all(&numbers(&[length, 0]))?;
        self.out.write_all(name.as_bytes())?;
        let before = self.out.count;
        let mut packer = Packer::new(&mut self.out);
        body(&mut packer)?;
        let (_, checksum, full) = packer.finish()?;
        let sizes = [checksum, small(self.out.count - before)?, small(full)?].map(u32::to_le_bytes).concat();
        self.out.write_all(b"PK\x07\x08")?;
        self.out.write_all(&sizes)?;
        self.directory.extend_from_slice(b"PK\x01\x02");
        self.directory.extend_from_slice(&numbers(&[VERSION]));
        self.directory.extend_from_slice(&common);
        self.directory.extend_from_slice(&sizes);
        // No extra field, no comment, the first disk, no attributes.
        self.directory.extend_from_slice(&numbers(&[length, 0, 0, 0, 0, 0, 0]));
        self.directory.extend_from_slice(&start.to_le_bytes());
        self.directory.extend_from_slice(name.as_bytes());
        self.files += 1;
        Ok(())
    }

    /// Writes the directory.
    ///
    /// # Errors
    /// If the underlying writer fails, or if the archive would be 4 GiB or larger.
    pub fn finish(mut self) -> io::Result<()> {
        let start = small(self.out.count)?;
        let length = small(self.directory.len() as u64)?;
        self.out.write_all(&self.directory)?;
        self.out.write_all(b"PK\x05\x06")?;
        self.out.write_all(&numbers(&[0, 0, self.files, self.files]))?;
        self.out.write_all(&[length, start].map(u32::to_le_bytes).concat())?;
        self.out.write_all(&numbers(&[0]))
    }
}

fn numbers(values: &[u16]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

/// Converts a size or a position to 32 bits; fails if it is too large.
fn small(size: u64) -> io::Result<u32> {
    let refused =
        |_| Error::new(ErrorKind::Request, "the file would be 4 GiB or larger, more than its format can hold");
    Ok(u32::try_from(size).map_err(refused)?)
}

/// A writer that counts its bytes.
struct Counted<'a> {
    out: &'a mut dyn Write,
    count: u64,
}

impl Write for Counted<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.out.write(bytes)?;
        self.count += written as u64;
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::zip::only_file;
    use std::io::Cursor;

    #[test]
    fn an_archive_is_read_again() {
        let body: Vec<u8> = (0..200_000u32).map(|k| (k % 251) as u8 ^ (k >> 11) as u8).collect();
        let write = |parts: usize| {
            let mut bytes = Vec::new();
            let mut zip = ZipWriter::new(&mut bytes);
            let file = |out: &mut dyn Write| body.chunks(body.len() / parts).try_for_each(|part| out.write_all(part));
            zip.file("a/b.bin", file).unwrap();
            zip.finish().unwrap();
            bytes
        };
        let bytes = write(1);
        assert_eq!(only_file(&mut Cursor::new(&bytes), 1 << 20).unwrap(), body);
        assert!(bytes == write(7) && bytes.len() < body.len() / 10);
    }

    #[test]
    fn the_directory_has_every_file() {
        let mut bytes = Vec::new();
        let mut zip = ZipWriter::new(&mut bytes);
        for name in ["one", "two", "three"] {
            zip.file(name, |out| out.write_all(name.as_bytes())).unwrap();
        }
        zip.finish().unwrap();
        let number = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        let end = bytes.len() - 22;
        assert_eq!((&bytes[end..end + 4], bytes[end + 10]), (&b"PK\x05\x06"[..], 3));
        let mut at = number(end + 16);
        assert_eq!(at + number(end + 12), end);
        for name in ["one", "two", "three"] {
            assert_eq!(
                (&bytes[at..at + 4], &bytes[at + 46..at + 46 + name.len()]),
                (&b"PK\x01\x02"[..], name.as_bytes())
            );
            assert_eq!((number(at + 16) as u32, number(at + 24)), (crc32fast::hash(name.as_bytes()), name.len()));
            let local = number(at + 42);
            assert_eq!(
                (&bytes[local..local + 4], &bytes[local + 30..][..name.len()]),
                (&b"PK\x03\x04"[..], name.as_bytes())
            );
            at += 46 + name.len();
        }
        assert_eq!(at, end);
    }
}
