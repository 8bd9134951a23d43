//! File system access. With the feature `fs` this is `std::fs`, extended by objects of a store such as S3.
//! Without it the module has the same items, but each fails with [`std::io::ErrorKind::Unsupported`]. On WebAssembly
//! without an operating system, files are in memory.
//!
//! All libraries of Orogen access files through this module. A host without a file system can therefore run everything
//! that needs no files, and gets an error that states the reason for everything else.

use std::path::{Path, PathBuf};

#[cfg(not(feature = "fs"))]
mod absent;
#[cfg(all(feature = "fs", any(test, target_os = "unknown")))]
#[doc(hidden)]
pub mod memory;
#[cfg(all(feature = "fs", not(target_os = "unknown")))]
pub mod objects;
#[cfg(all(feature = "fs", not(target_os = "unknown")))]
mod present;

#[cfg(not(feature = "fs"))]
pub use absent::*;
#[cfg(all(feature = "fs", target_os = "unknown"))]
pub use memory::*;
#[cfg(all(feature = "fs", not(target_os = "unknown")))]
pub use objects::{is_read_only, is_remote};
#[cfg(all(feature = "fs", not(target_os = "unknown")))]
pub use present::*;

/// Whether this build has a file system (the feature `fs`).
pub const AVAILABLE: bool = cfg!(feature = "fs");

/// Whether a file exists at `path`; links are followed.
#[must_use]
pub fn is_file(path: &Path) -> bool {
    match is_remote(path) {
        // Without looking for a folder of that name.
        true => File::open(path).is_ok(),
        false => metadata(path).is_ok_and(|there| there.is_file()),
    }
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

/// The system's temporary folder; an empty path on a host without files, and for files in memory.
#[must_use]
pub fn temporary_folder() -> PathBuf {
    match AVAILABLE && !cfg!(target_os = "unknown") {
        true => std::env::temp_dir(),
        false => PathBuf::new(),
    }
}

/// The number of this process; 0 on a host without processes.
#[must_use]
pub fn process() -> u32 {
    if cfg!(target_os = "unknown") { 0 } else { std::process::id() }
}

/// Whether the name is in use, even by a dangling link.
#[must_use]
pub fn is_taken(path: &Path) -> bool {
    symlink_metadata(path).is_ok()
}

/// `path`, relative to `folder` unless it is absolute or a URL.
#[must_use]
pub fn joined(folder: &Path, path: impl AsRef<Path>) -> PathBuf {
    match is_remote(&path) {
        true => path.as_ref().to_path_buf(),
        false => folder.join(path),
    }
}

/// The folder that contains `path`.
#[must_use]
pub fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}
