//! A sequence of records of one kind, in memory or compressed in a [`Spool`], so that files of any size can be written
//! in bounded memory.

use std::io::{self, Write};
use std::marker::PhantomData;
use std::sync::{Mutex, PoisonError};

use crate::format::deflate::stream::{Deflate, Inflate, MEMORY as STREAM, Wrap};
use crate::spool::Spool;

/// Compression level. Tiles take 7 % more space than at level 6, and half the time.
const LEVEL: u8 = 3;

/// Number of compressed bytes that are read at once.
const PIECE: usize = 64 << 10;

/// Number of uncompressed bytes that are converted at once.
const BLOCK: usize = 48 << 10;

/// Memory of compressed records in bytes, without their bytes in the spool.
pub const MEMORY: u64 = STREAM + 2 * BLOCK as u64;

/// A value with a fixed number of bytes.
pub trait Record: Copy {
    /// Number of bytes.
    const BYTES: usize;

    /// Writes the bytes of the value.
    fn put(self, bytes: &mut [u8]);

    /// The value with these bytes.
    fn get(bytes: &[u8]) -> Self;

    /// Replaces the content of `bytes` with the bytes of records.
    fn put_all(records: &[Self], bytes: &mut Vec<u8>) {
        bytes.resize(records.len() * Self::BYTES, 0);
        bytes.chunks_exact_mut(Self::BYTES).zip(records).for_each(|(bytes, record)| record.put(bytes));
    }

    /// Appends the records in `bytes`.
    fn get_all(bytes: &[u8], to: &mut Vec<Self>) {
        to.extend(bytes.chunks_exact(Self::BYTES).map(Self::get));
    }
}

impl Record for u8 {
    const BYTES: usize = 1;

    fn put(self, bytes: &mut [u8]) {
        bytes.fill(self);
    }

    fn get(bytes: &[u8]) -> u8 {
        bytes.first().copied().unwrap_or_default()
    }

    // These replace the default methods, which would be compiled in the calling crate.
    fn put_all(records: &[u8], bytes: &mut Vec<u8>) {
        bytes.clear();
        bytes.extend_from_slice(records);
    }

    fn get_all(bytes: &[u8], to: &mut Vec<u8>) {
        to.extend_from_slice(bytes);
    }
}

/// Little-endian bytes.
impl Record for u32 {
    const BYTES: usize = 4;

    fn put(self, bytes: &mut [u8]) {
        bytes.copy_from_slice(&self.to_le_bytes());
    }

    fn get(bytes: &[u8]) -> u32 {
        bytes.try_into().map(u32::from_le_bytes).unwrap_or_default()
    }

    fn put_all(records: &[u32], bytes: &mut Vec<u8>) {
        bytes.clear();
        bytes.extend(records.iter().flat_map(|record| record.to_le_bytes()));
    }

    fn get_all(bytes: &[u8], to: &mut Vec<u32>) {
        to.extend(bytes.as_chunks().0.iter().map(|bytes| u32::from_le_bytes(*bytes)));
    }
}

/// A sequence of records.
pub struct Records<T> {
    length: u64,
    stored: Stored<T>,
}

enum Stored<T> {
    Memory(Vec<T>),
    Packed(Mutex<Spool>),
}

impl<T> std::fmt::Debug for Records<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.debug_struct("Records").field("length", &self.length).finish_non_exhaustive()
    }
}

impl<T> From<Vec<T>> for Records<T> {
    fn from(records: Vec<T>) -> Records<T> {
        Records { length: records.len() as u64, stored: Stored::Memory(records) }
    }
}

impl<T: Record> Records<T> {
    /// Number of records.
    #[must_use]
    pub fn len(&self) -> u64 {
        self.length
    }

    /// Whether there are no records.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.length == 0
    }

    /// All records, if they are in memory.
    #[must_use]
    pub fn in_memory(&self) -> Option<&[T]> {
        match &self.stored {
            Stored::Memory(records) => Some(records),
            Stored::Packed(_) => None,
        }
    }

    /// All records.
    ///
    /// Fails if the disk fails.
    pub fn to_vec(&self) -> io::Result<Vec<T>> {
        let mut all = Vec::new();
        self.reader().read(usize::try_from(self.length).unwrap_or(usize::MAX), &mut all)?;
        Ok(all)
    }

    /// A reader that starts at the first record.
    #[must_use]
    pub fn reader(&self) -> Reader<'_, T> {
        let inflate = match &self.stored {
            Stored::Memory(_) => None,
            Stored::Packed(_) => Some(Inflate::new()),
        };
        Reader { records: self, next: 0, inflate, packed: 0, bytes: Vec::new() }
    }

    /// Writes the bytes of all records as one zlib stream. The stream does not depend on where the records are stored.
    ///
    /// Fails if `out` or the disk fails.
    pub fn write_packed(&self, out: &mut dyn Write) -> io::Result<()> {
        match &self.stored {
            Stored::Memory(records) => {
                let (mut stream, mut bytes) = (Deflate::new(Wrap::Zlib, LEVEL), Vec::new());
                for part in records.chunks(BLOCK / T::BYTES) {
                    T::put_all(part, &mut bytes);
                    stream.write(out, &bytes)?;
                }
                stream.finish(out)
            }
            Stored::Packed(spool) => {
                let (mut at, mut piece) = (0, Vec::new());
                loop {
                    at += next_piece(spool, at, &mut piece)?;
                    if piece.is_empty() {
                        return Ok(());
                    }
                    out.write_all(&piece)?;
                }
            }
        }
    }
}

/// Reads the next piece of a spool, from `at` on; it is empty at the end. Returns its length.
fn next_piece(spool: &Mutex<Spool>, at: u64, piece: &mut Vec<u8>) -> io::Result<u64> {
    let mut spool = spool.lock().unwrap_or_else(PoisonError::into_inner);
    let length = (spool.length() - at).min(PIECE as u64);
    piece.resize(length as usize, 0);
    spool.read(at, piece)?;
    Ok(length)
}

/// Reads records in order.
pub struct Reader<'r, T> {
    records: &'r Records<T>,
    /// The index of the next record.
    next: u64,
    inflate: Option<Inflate>,
    /// Number of compressed bytes that were read.
    packed: u64,
    bytes: Vec<u8>,
}

impl<T: Record> Reader<'_, T> {
    /// Replaces the content of `to` with the next `count` records, or with as many as there are.
    ///
    /// Fails if the disk fails.
    pub fn read(&mut self, count: usize, to: &mut Vec<T>) -> io::Result<()> {
        to.clear();
        let count = (count as u64).min(self.records.length - self.next) as usize;
        let next = self.next as usize;
        self.next += count as u64;
        match (&self.records.stored, &mut self.inflate) {
            (Stored::Packed(spool), Some(inflate)) => {
                let packed = &mut self.packed;
                let mut left = count;
                while left > 0 {
                    let block = left.min(BLOCK / T::BYTES);
                    left -= block;
                    self.bytes.resize(block * T::BYTES, 0);
                    inflate.read(&mut self.bytes, |piece| {
                        *packed += next_piece(spool, *packed, piece)?;
                        Ok(())
                    })?;
                    T::get_all(&self.bytes, to);
                }
            }
            (Stored::Memory(records), _) => to.extend_from_slice(&records[next..next + count]),
            (Stored::Packed(_), None) => return Err(io::ErrorKind::UnexpectedEof.into()),
        }
        Ok(())
    }

    /// Skips records.
    ///
    /// Fails if the disk fails.
    pub fn skip(&mut self, count: u64) -> io::Result<()> {
        let mut unused = Vec::new();
        let end = (self.next + count).min(self.records.length);
        if self.inflate.is_none() {
            self.next = end;
        }
        while self.next < end {
            self.read((end - self.next).min((BLOCK / T::BYTES) as u64) as usize, &mut unused)?;
        }
        Ok(())
    }
}

/// Collects [`Records`].
pub struct Recorder<T> {
    length: u64,
    kept: Kept<T>,
}

enum Kept<T> {
    Memory(Vec<T>),
    Packed { spool: Spool, stream: Deflate, bytes: Vec<u8>, of: PhantomData<T> },
}

impl<T: Record> Recorder<T> {
    /// Keeps records in memory.
    #[must_use]
    pub fn in_memory() -> Recorder<T> {
        Recorder { length: 0, kept: Kept::Memory(Vec::new()) }
    }

    /// Compresses records into a spool.
    #[must_use]
    pub fn packed(spool: Spool) -> Recorder<T> {
        let kept = Kept::Packed { spool, stream: Deflate::new(Wrap::Zlib, LEVEL), bytes: Vec::new(), of: PhantomData };
        Recorder { length: 0, kept }
    }

    /// Adds records.
    ///
    /// Fails if the disk is full or fails.
    pub fn push(&mut self, records: &[T]) -> io::Result<()> {
        self.length += records.len() as u64;
        match &mut self.kept {
            Kept::Memory(kept) => kept.extend_from_slice(records),
            Kept::Packed { spool, stream, bytes, .. } => {
                for part in records.chunks(BLOCK / T::BYTES) {
                    T::put_all(part, bytes);
                    stream.write(spool, bytes)?;
                }
            }
        }
        Ok(())
    }

    /// The records that were added.
    ///
    /// Fails if the disk is full or fails.
    pub fn finish(self) -> io::Result<Records<T>> {
        let stored = match self.kept {
            Kept::Memory(records) => Stored::Memory(records),
            Kept::Packed { mut spool, stream, .. } => {
                stream.finish(&mut spool)?;
                Stored::Packed(Mutex::new(spool))
            }
        };
        Ok(Records { length: self.length, stored })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packed_records_are_those_in_memory() {
        for length in [0usize, 1, 999, 100_000] {
            let all: Vec<u32> = (0..length as u32).map(|k| k.wrapping_mul(k) >> 5).collect();
            let [memory, packed] = [Recorder::in_memory(), Recorder::packed(Spool::in_memory())].map(|mut recorder| {
                all.chunks(777).for_each(|part| recorder.push(part).unwrap());
                recorder.finish().unwrap()
            });
            assert_eq!((memory.len(), packed.len(), packed.is_empty()), (length as u64, length as u64, length == 0));
            assert!(memory.in_memory() == Some(&all) && packed.in_memory().is_none());
            let [bytes, same] = [&memory, &packed].map(|records| {
                assert!(records.to_vec().unwrap() == all);
                let (mut reader, mut part) = (records.reader(), Vec::new());
                reader.skip(500).unwrap();
                reader.read(70_000, &mut part).unwrap();
                assert!(part[..] == all[500.min(length)..70_500.min(length)]);
                let mut bytes = Vec::new();
                records.write_packed(&mut bytes).unwrap();
                bytes
            });
            assert!(bytes == same, "{length}");
            let unpacked = miniz_oxide::inflate::decompress_to_vec_zlib(&bytes).unwrap();
            assert!(unpacked == all.iter().flat_map(|n| n.to_le_bytes()).collect::<Vec<_>>());
        }
    }

    #[test]
    fn bytes_are_records() {
        let mut recorder = Recorder::packed(Spool::in_memory());
        recorder.push(&[3u8, 1, 2]).unwrap();
        assert_eq!(recorder.finish().unwrap().to_vec().unwrap(), [3, 1, 2]);
    }
}
