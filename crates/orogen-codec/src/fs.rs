//! File system access. With the feature `fs` this is `std::fs`. Without it the module has the same items, but each
//! fails with [`std::io::ErrorKind::Unsupported`].
//!
//! All libraries of Orogen access files through this module. A host without a file system can therefore run everything
//! that needs no files, and gets an error that states the reason for everything else.

use std::path::{Path, PathBuf};

#[cfg(not(feature = "fs"))]
mod absent;

#[cfg(not(feature = "fs"))]
pub use absent::*;
#[cfg(feature = "fs")]
pub use std::fs::*;

/// Whether this build has a file system (the feature `fs`).
pub const AVAILABLE: bool = cfg!(feature = "fs");

/// Whether a file exists at `path`; links are followed.
#[must_use]
pub fn is_file(path: &Path) -> bool {
    metadata(path).is_ok_and(|there| there.is_file())
}

/// Whether a folder exists at `path`; links are followed.
#[must_use]
pub fn is_dir(path: &Path) -> bool {
    metadata(path).is_ok_and(|there| there.is_dir())
}

/// Whether anything exists at `path`; links are followed.
#[must_use]
pub fn is_present(path: &Path) -> bool {
    metadata(path).is_ok()
}

/// The system's temporary folder; an empty path on a host without files.
#[must_use]
pub fn temporary_folder() -> PathBuf {
    match AVAILABLE && !cfg!(all(target_family = "wasm", not(target_os = "wasi"))) {
        true => std::env::temp_dir(),
        false => PathBuf::new(),
    }
}

/// Whether the name is in use, even by a dangling link.
#[must_use]
pub fn is_taken(path: &Path) -> bool {
    symlink_metadata(path).is_ok()
}

/// The folder that contains `path`.
#[must_use]
pub fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}
