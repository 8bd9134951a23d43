//! Bytes that are read by position, from any thread at any time.

use crate::fs::File;
use std::fmt::Debug;
use std::io;
use std::sync::Arc;

/// Bytes that are read by position. Several threads can read at the same time, because there is no shared position.
///
/// ```
/// use orogen_codec::read_at::ReadAt;
///
/// let bytes: Vec<u8> = (0..100).collect();
/// let mut part = [0; 3];
/// bytes.read_exact_at(10, &mut part)?;
/// assert_eq!((part, bytes.length()?), ([10, 11, 12], 100));
/// assert!(bytes.read_exact_at(98, &mut part).is_err());
/// # Ok::<(), std::io::Error>(())
/// ```
pub trait ReadAt: Send + Sync + Debug {
    /// Number of bytes.
    ///
    /// # Errors
    /// If it cannot be determined.
    fn length(&self) -> io::Result<u64>;

    /// Fills `bytes` with the bytes from offset `at` on.
    ///
    /// # Errors
    /// If there are not enough bytes ([`io::ErrorKind::UnexpectedEof`]), or if they cannot be read.
    fn read_exact_at(&self, at: u64, bytes: &mut [u8]) -> io::Result<()>;
}

impl ReadAt for [u8] {
    fn length(&self) -> io::Result<u64> {
        Ok(self.len() as u64)
    }

    fn read_exact_at(&self, at: u64, bytes: &mut [u8]) -> io::Result<()> {
        let start = usize::try_from(at).map_err(|_| io::ErrorKind::UnexpectedEof)?;
        let part = self.get(start..).and_then(|rest| rest.get(..bytes.len()));
        bytes.copy_from_slice(part.ok_or(io::ErrorKind::UnexpectedEof)?);
        Ok(())
    }
}

impl ReadAt for Vec<u8> {
    fn length(&self) -> io::Result<u64> {
        self.as_slice().length()
    }

    fn read_exact_at(&self, at: u64, bytes: &mut [u8]) -> io::Result<()> {
        self.as_slice().read_exact_at(at, bytes)
    }
}

impl<T: ReadAt + ?Sized> ReadAt for Arc<T> {
    fn length(&self) -> io::Result<u64> {
        (**self).length()
    }

    fn read_exact_at(&self, at: u64, bytes: &mut [u8]) -> io::Result<()> {
        (**self).read_exact_at(at, bytes)
    }
}

impl<T: ReadAt + ?Sized> ReadAt for Box<T> {
    fn length(&self) -> io::Result<u64> {
        (**self).length()
    }

    fn read_exact_at(&self, at: u64, bytes: &mut [u8]) -> io::Result<()> {
        (**self).read_exact_at(at, bytes)
    }
}

/// A file that is read and written by position. On Unix and Windows this needs no lock. On other systems each access
/// sets the file's own position under a lock.
#[derive(Debug)]
pub struct PositionedFile {
    file: File,
    #[cfg(not(all(feature = "fs", any(unix, windows))))]
    position: std::sync::Mutex<()>,
}

impl PositionedFile {
    /// Wraps an open file.
    #[must_use]
    pub fn new(file: impl Into<File>) -> PositionedFile {
        PositionedFile {
            file: file.into(),
            #[cfg(not(all(feature = "fs", any(unix, windows))))]
            position: std::sync::Mutex::default(),
        }
    }

    /// Writes all of `bytes` from offset `at` on.
    ///
    /// # Errors
    /// If the disk is full or fails.
    pub fn write_all_at(&self, at: u64, bytes: &[u8]) -> io::Result<()> {
        self.write_at(at, bytes)
    }

    #[cfg(all(feature = "fs", any(unix, windows)))]
    fn write_at(&self, at: u64, bytes: &[u8]) -> io::Result<()> {
        self.file.write_all_at(at, bytes)
    }

    #[cfg(all(feature = "fs", any(unix, windows)))]
    fn fill_from(&self, at: u64, bytes: &mut [u8]) -> io::Result<()> {
        self.file.read_exact_at(at, bytes)
    }

    #[cfg(not(all(feature = "fs", any(unix, windows))))]
    fn write_at(&self, at: u64, bytes: &[u8]) -> io::Result<()> {
        use std::io::{Seek, Write};
        let _held = self.position.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        (&self.file).seek(io::SeekFrom::Start(at))?;
        (&self.file).write_all(bytes)
    }

    #[cfg(not(all(feature = "fs", any(unix, windows))))]
    fn fill_from(&self, at: u64, bytes: &mut [u8]) -> io::Result<()> {
        use std::io::{Read, Seek};
        let _held = self.position.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        (&self.file).seek(io::SeekFrom::Start(at))?;
        (&self.file).read_exact(bytes)
    }
}

impl ReadAt for PositionedFile {
    fn length(&self) -> io::Result<u64> {
        Ok(self.file.metadata()?.len())
    }

    fn read_exact_at(&self, at: u64, bytes: &mut [u8]) -> io::Result<()> {
        self.fill_from(at, bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::temporary::Temporary;

    /// The byte at an offset.
    fn byte(at: u64) -> u8 {
        (at.wrapping_mul(0x9E37_79B9) >> 13) as u8
    }

    #[test]
    fn threads_read_and_write_one_file_at_positions_of_their_own() {
        let (_name, file) = Temporary::create(&std::env::temp_dir()).unwrap();
        let file = PositionedFile::new(file);
        const PART: u64 = 4096;
        std::thread::scope(|scope| {
            for thread in 0..4 {
                let file = &file;
                scope.spawn(move || {
                    for part in (0..64).filter(|part| part % 4 == thread) {
                        let bytes: Vec<u8> = (part * PART..(part + 1) * PART).map(byte).collect();
                        file.write_all_at(part * PART, &bytes).unwrap();
                        let mut back = vec![0; PART as usize];
                        file.read_exact_at(part * PART, &mut back).unwrap();
                        assert!(back == bytes, "part {part}");
                    }
                });
            }
        });
        assert_eq!(file.length().unwrap(), 64 * PART);
        let mut all = vec![0; 64 * PART as usize];
        file.read_exact_at(0, &mut all).unwrap();
        assert!(all.iter().zip(0..).all(|(there, at)| *there == byte(at)));
        assert_eq!(file.read_exact_at(1, &mut all).unwrap_err().kind(), io::ErrorKind::UnexpectedEof);
        assert_eq!(all.read_exact_at(u64::MAX, &mut [0]).unwrap_err().kind(), io::ErrorKind::UnexpectedEof);
    }
}
