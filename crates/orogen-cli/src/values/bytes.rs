//! `--memory`, `--cache-limit` and other numbers of bytes.

use std::str::FromStr;

/// Bytes, with or without a unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bytes(pub u64);

impl FromStr for Bytes {
    type Err = String;

    fn from_str(text: &str) -> Result<Bytes, String> {
        orogen::budget::bytes(text).map(Bytes)
    }
}
