//! The first directory of a TIFF, parsed without trusting the file.

use std::io::SeekFrom;

use crate::format::dem::{self, Input};

/// Maximum number of entries of a directory; TIFF defines far fewer tags.
const MAX_ENTRIES: u64 = 4096;

/// Maximum number of directories searched for the full raster.
const MAX_DIRECTORIES: usize = 64;

/// Bits of the subfile type.
const REDUCED: u64 = 1;
const MASK: u64 = 4;

/// An opened TIFF with the entries of the directory of its full raster.
pub struct Tiff<'a> {
    input: &'a mut dyn Input,
    /// Length of the file in bytes.
    pub length: u64,
    /// Whether numbers are big-endian.
    pub big_endian: bool,
    big: bool,
    /// Position of the first directory.
    first: u64,
    entries: Vec<Entry>,
}

struct Entry {
    tag: u16,
    kind: u16,
    count: u64,
    /// Position of the values in the file.
    at: u64,
}

type Fallible<T> = Result<T, String>;

impl<'a> Tiff<'a> {
    /// Reads the header and the directory.
    pub fn open(input: &'a mut dyn Input) -> Fallible<Tiff<'a>> {
        let length = dem::length(input)?;
        let mut tiff = Tiff { input, length, big_endian: false, big: false, first: 0, entries: Vec::new() };
        let head = tiff.bytes(0, length.min(8), "header")?;
        let (big_endian, version) = match head.get(..4) {
            Some([b'I', b'I', low, 0]) => (false, *low),
            Some([b'M', b'M', 0, low]) => (true, *low),
            _ => return Err("it is not a TIFF".into()),
        };
        (tiff.big_endian, tiff.big) = match version {
            42 => (big_endian, false),
            43 => (big_endian, true),
            _ => return Err("it is not a TIFF".into()),
        };
        tiff.first = if tiff.big { tiff.number(8, 8)? } else { tiff.number(4, 4)? };
        match tiff.seek(|_, kind| Ok(kind & (REDUCED | MASK) == 0))? {
            true => Ok(tiff),
            false => Err("it has no full raster, only overviews or masks".into()),
        }
    }

    /// Moves to the directory of the mask of the full raster, which has `size` samples; returns false if there is none.
    pub fn seek_mask(&mut self, size: [u64; 2]) -> Fallible<bool> {
        self.seek(
            |tiff, kind| Ok(kind & (REDUCED | MASK) == MASK && [tiff.one(256)?, tiff.one(257)?] == size.map(Some)),
        )
    }

    /// Moves to the first directory whose subfile type `wanted` accepts.
    fn seek(&mut self, wanted: impl Fn(&mut Self, u64) -> Fallible<bool>) -> Fallible<bool> {
        let mut at = self.first;
        for _ in 0..MAX_DIRECTORIES {
            if at == 0 {
                break;
            }
            let next = self.directory(at)?;
            let kind = self.one(254)?.unwrap_or(0);
            if wanted(self, kind)? {
                return Ok(true);
            }
            at = next;
        }
        Ok(false)
    }

    /// `count` bytes at `at`.
    pub fn bytes(&mut self, at: u64, count: u64, what: &str) -> Fallible<Vec<u8>> {
        if at.checked_add(count).is_none_or(|end| end > self.length) {
            return Err(format!(
                "it ends within its {what}, which should reach byte {}; the file has {}",
                at.saturating_add(count),
                self.length
            ));
        }
        self.input.seek(SeekFrom::Start(at)).map_err(|cause| cause.to_string())?;
        let mut bytes = vec![0; count as usize];
        self.input.read_exact(&mut bytes).map_err(|cause| cause.to_string())?;
        Ok(bytes)
    }

    /// An integer of `size` bytes.
    pub fn whole(&self, bytes: &[u8]) -> u64 {
        match self.big_endian {
            true => bytes.iter().fold(0, |number, byte| number << 8 | u64::from(*byte)),
            false => bytes.iter().rev().fold(0, |number, byte| number << 8 | u64::from(*byte)),
        }
    }

    fn number(&mut self, at: u64, size: u64) -> Fallible<u64> {
        let bytes = self.bytes(at, size, "directory")?;
        Ok(self.whole(&bytes))
    }

    /// Reads the directory at `at`; returns the position of the next one.
    fn directory(&mut self, at: u64) -> Fallible<u64> {
        let (count_size, word) = if self.big { (8, 8) } else { (2, 4) };
        let count = self.number(at, count_size)?;
        if count > MAX_ENTRIES {
            return Err(format!("its directory declares {count} entries; it is damaged"));
        }
        let each = 4 + 2 * word;
        let first = at + count_size;
        let table = self.bytes(first, count * each, "directory")?;
        self.entries.clear();
        for (k, entry) in table.chunks_exact(each as usize).enumerate() {
            let [tag, kind] = [&entry[..2], &entry[2..4]].map(|bytes| self.whole(bytes) as u16);
            let count = self.whole(&entry[4..4 + word as usize]);
            let inline = first + k as u64 * each + 4 + word;
            let fits = size_of_kind(kind).and_then(|size| size.checked_mul(count)).is_some_and(|size| size <= word);
            let at = if fits { inline } else { self.whole(&entry[4 + word as usize..]) };
            self.entries.push(Entry { tag, kind, count, at });
        }
        self.number(first + count * each, word)
    }

    /// A tag's values as bytes, with their type; `None` if the tag is absent.
    fn values(&mut self, tag: u16) -> Fallible<Option<(u16, Vec<u8>)>> {
        let Some(entry) = self.entries.iter().find(|entry| entry.tag == tag) else { return Ok(None) };
        let (kind, count, at) = (entry.kind, entry.count, entry.at);
        let size = size_of_kind(kind).ok_or_else(|| format!("its tag {tag} is of the unknown type {kind}"))?;
        let bytes = self.bytes(at, size.saturating_mul(count), &format!("tag {tag}"))?;
        Ok(Some((kind, bytes)))
    }

    /// A tag's values as integers.
    pub fn wholes(&mut self, tag: u16) -> Fallible<Option<Vec<u64>>> {
        let Some((kind, bytes)) = self.values(tag)? else { return Ok(None) };
        match kind {
            1 | 3 | 4 | 13 | 16 => {
                let size = size_of_kind(kind).unwrap_or(1) as usize;
                Ok(Some(bytes.chunks_exact(size).map(|bytes| self.whole(bytes)).collect()))
            }
            _ => Err(format!("its tag {tag} does not hold whole numbers")),
        }
    }

    /// A tag's first value as an integer.
    pub fn one(&mut self, tag: u16) -> Fallible<Option<u64>> {
        Ok(self.wholes(tag)?.and_then(|values| values.first().copied()))
    }

    /// A tag's values as f64.
    pub fn doubles(&mut self, tag: u16) -> Fallible<Option<Vec<f64>>> {
        let Some((kind, bytes)) = self.values(tag)? else { return Ok(None) };
        match kind {
            12 => Ok(Some(bytes.chunks_exact(8).map(|bytes| f64::from_bits(self.whole(bytes))).collect())),
            _ => Err(format!("its tag {tag} does not hold numbers of 64 bits")),
        }
    }

    /// A tag's text without its terminator.
    pub fn text(&mut self, tag: u16) -> Fallible<Option<String>> {
        let Some((_, bytes)) = self.values(tag)? else { return Ok(None) };
        Ok(Some(String::from_utf8_lossy(&bytes).trim_end_matches('\0').to_string()))
    }
}

/// Bytes per value of a type.
fn size_of_kind(kind: u16) -> Option<u64> {
    match kind {
        1 | 2 | 6 | 7 => Some(1),
        3 | 8 => Some(2),
        4 | 9 | 11 | 13 => Some(4),
        5 | 10 | 12 | 16 | 17 | 18 => Some(8),
        _ => None,
    }
}
