//! The keys of a store's entries.

use crate::plan::key::Key;
use sha2::{Digest, Sha256};
use std::fmt;
use std::str::FromStr;

/// The key of an entry: a hash of the content key of a solver, or of a levelled op with the level and the tile, and of
/// the version of this library. It is displayed, and read back, as 64 hexadecimal digits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct EntryKey(pub [u8; 32]);

impl EntryKey {
    /// The key under which the result with a content key is stored.
    pub(crate) fn of(key: &Key) -> EntryKey {
        let mut hash = Sha256::new();
        hash.update(key);
        hash.update(env!("CARGO_PKG_VERSION"));
        EntryKey(hash.finalize().into())
    }
}

impl fmt::Display for EntryKey {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        self.0.iter().try_for_each(|byte| write!(formatter, "{byte:02x}"))
    }
}

/// A text that is not 64 hexadecimal digits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NoEntryKey;

impl fmt::Display for NoEntryKey {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.write_str("the key of an entry has 64 hexadecimal digits")
    }
}

impl std::error::Error for NoEntryKey {}

impl FromStr for EntryKey {
    type Err = NoEntryKey;

    fn from_str(text: &str) -> Result<EntryKey, NoEntryKey> {
        if text.len() != 64 || !text.bytes().all(|byte| byte.is_ascii_hexdigit()) {
            return Err(NoEntryKey);
        }
        let mut key = [0; 32];
        for (byte, pair) in key.iter_mut().zip(text.as_bytes().as_chunks().0) {
            let [high, low]: [u8; 2] = *pair;
            let digit = |digit: u8| (digit as char).to_digit(16).unwrap_or_default() as u8;
            *byte = 16 * digit(high) + digit(low);
        }
        Ok(EntryKey(key))
    }
}
