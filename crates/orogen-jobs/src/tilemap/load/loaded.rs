//! Common parts of the readers of tilesets.

use std::path::{Path, PathBuf};

use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_io::open;

use crate::tilemap::tileset::Tileset;

/// Maximum length of the text of a tileset, in bytes.
const MAX_TEXT: u64 = 16 << 20;

/// A tileset from a file.
#[derive(Debug)]
pub struct Loaded {
    /// The tileset.
    pub tileset: Tileset,
    /// The picture of the tiles.
    pub picture: PathBuf,
}

/// The error for an unusable tileset, with the reason.
pub(super) fn unusable(path: &Path, why: &str) -> Error {
    Error::new(ErrorKind::File, format!("cannot use the tileset {}: {why}", path.display()))
}

/// Reads the text of a file.
pub(super) fn text(path: &Path) -> Result<String> {
    let bytes = open::bytes(path, "read the tileset", MAX_TEXT)?
        .ok_or_else(|| unusable(path, &format!("it is larger than {} MB", MAX_TEXT >> 20)))?;
    String::from_utf8(bytes).map_err(|_| unusable(path, "it is no text in UTF-8"))
}
