//! Length and checksum of a file.

use std::io::{self, Read, Write};
use std::path::Path;

use orogen_grid::hex;
use orogen_io::fs::{self, File};
use sha2::{Digest, Sha256};

/// Bytes of a file that are read at a time.
const BUFFER: usize = 1 << 20;

/// Length and checksum of a written file, to detect changes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FileDigest {
    /// The length in bytes.
    pub length: u64,
    /// The SHA-256 in hexadecimal digits.
    pub sha256: String,
}

impl FileDigest {
    /// The digest of these bytes.
    pub fn of(bytes: &[u8]) -> FileDigest {
        FileDigest { length: bytes.len() as u64, sha256: hex::encode(&Sha256::digest(bytes)) }
    }

    /// The digest of the file at `path`.
    pub fn of_file(path: &Path) -> io::Result<FileDigest> {
        let mut file = File::open(path)?;
        let (mut hash, mut length) = (Sha256::new(), 0);
        let mut buffer = vec![0; BUFFER];
        loop {
            let count = match file.read(&mut buffer) {
                Ok(0) => return Ok(FileDigest { length, sha256: hex::encode(&hash.finalize()) }),
                Ok(count) => count,
                Err(cause) if cause.kind() == io::ErrorKind::Interrupted => continue,
                Err(cause) => return Err(cause),
            };
            hash.update(&buffer[..count]);
            length += count as u64;
        }
    }

    /// Whether the file at `path` has this digest; false if it cannot be read. Of an object, only the length is
    /// compared: stores check the bytes that they receive, and an object is there whole or not at all.
    pub fn is_at(&self, path: &Path) -> bool {
        if fs::is_remote(path) {
            return self.has_length_of(path);
        }
        self.has_length_of(path) && FileDigest::of_file(path).is_ok_and(|digest| digest == *self)
    }

    /// Whether the file at `path` has this length.
    pub fn has_length_of(&self, path: &Path) -> bool {
        File::open(path)
            .and_then(|file| file.metadata())
            .is_ok_and(|there| there.is_file() && there.len() == self.length)
    }
}

/// A writer that computes the digest of the written bytes.
pub struct Measured<W> {
    inner: W,
    hash: Sha256,
    length: u64,
}

impl<W: Write> Measured<W> {
    /// Wraps a writer that has received nothing yet.
    pub fn new(inner: W) -> Measured<W> {
        Measured { inner, hash: Sha256::new(), length: 0 }
    }

    /// Returns the writer and the digest.
    pub fn end(self) -> (W, FileDigest) {
        (self.inner, FileDigest { length: self.length, sha256: hex::encode(&self.hash.finalize()) })
    }
}

impl<W: Write> Write for Measured<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let count = self.inner.write(bytes)?;
        self.hash.update(&bytes[..count]);
        self.length += count as u64;
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_io::test_folder::TestFolder;

    #[test]
    fn any_change_of_a_file_is_noticed() {
        let folder = TestFolder::new("digest").unwrap();
        let path = folder.join("piece");
        let bytes: Vec<u8> = (0..3_000_000u32).map(|n| n.wrapping_mul(n) as u8).collect();
        let digest = FileDigest::of(&bytes);
        assert!(!digest.is_at(&path), "it is not there");
        let mut out = Measured::new(File::create(&path).unwrap());
        bytes.chunks(700_001).for_each(|chunk| out.write_all(chunk).unwrap());
        assert_eq!(out.end().1, digest);
        assert!(digest.is_at(&path));
        for at in [0, 1_500_000, bytes.len() - 1] {
            let mut other = bytes.clone();
            other[at] ^= 1;
            std::fs::write(&path, &other).unwrap();
            assert!(!digest.is_at(&path), "flipped at {at}");
        }
        std::fs::write(&path, &bytes[1..]).unwrap();
        assert!(!digest.is_at(&path), "cut");
        assert_eq!(
            FileDigest::of(b"abc").sha256,
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad",
            "FIPS 180-2"
        );
    }
}
