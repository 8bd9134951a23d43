//! Opening of input files. Named pipes and devices may block or never end, so they are rejected.

use std::io::Read;
use std::path::Path;

use crate::fs::{self, File};
use orogen_grid::error::{Error, ErrorKind, Result};

/// Paths of descriptors that the parent process has opened, such as a shell's `<(command)`. Opening them does not
/// block.
const INHERITED: [&str; 4] = ["/dev/fd/", "/dev/stdin", "/proc/self/fd/", "/proc/thread-self/fd/"];

/// Opens a regular file. `doing` is the action for messages, such as "read the recipe".
///
/// # Errors
/// If it cannot be opened, or is a folder, a named pipe or a device.
pub fn regular(path: &Path, doing: &str) -> Result<File> {
    open(path, doing, false)
}

/// The bytes of a regular file, or of an inherited pipe; `None` if there are more than `most`.
///
/// # Errors
/// If it cannot be read, or is a folder, a named pipe or a device.
pub fn bytes(path: &Path, doing: &str, most: u64) -> Result<Option<Vec<u8>>> {
    let mut bytes = Vec::new();
    // Reads up to a limit instead of the stated length, because a pipe does not state one.
    let read = open(path, doing, true)?.take(most.saturating_add(1)).read_to_end(&mut bytes);
    read.map_err(|cause| Error::file(doing, path, &cause))?;
    Ok((bytes.len() as u64 <= most).then_some(bytes))
}

fn open(path: &Path, doing: &str, inherited: bool) -> Result<File> {
    let failed = |cause: std::io::Error| Error::file(doing, path, &cause);
    let kind = fs::metadata(path).map_err(failed)?;
    let is_inherited = || INHERITED.iter().any(|folder| path.to_string_lossy().starts_with(folder));
    if kind.is_file() || inherited && !kind.is_dir() && is_inherited() {
        return File::open(path).map_err(failed);
    }
    let why = match kind.is_dir() {
        true => "it is a folder",
        false => "it is a pipe or a device; save its content to a file first",
    };
    Err(Error::new(ErrorKind::File, format!("cannot {doing} {}: {why}", path.display())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_ends_is_read() {
        let path = std::env::temp_dir().join(format!("orogen-open-{}", std::process::id()));
        fs::write(&path, b"12345").unwrap();
        assert_eq!(bytes(&path, "read", 5).unwrap().unwrap(), b"12345");
        assert_eq!(bytes(&path, "read", 4).unwrap(), None);
        assert!(regular(&path, "read").is_ok());
        fs::remove_file(&path).unwrap();
        let message = |path: &str| bytes(Path::new(path), "read the palette", 5).unwrap_err().to_string();
        assert!(message(&path.to_string_lossy()).starts_with("cannot read the palette "));
        let folder = std::env::temp_dir();
        assert!(message(&folder.to_string_lossy()).ends_with("it is a folder"));
        if cfg!(unix) {
            assert!(message("/dev/zero").contains("/dev/zero: it is a pipe or a device"));
            assert!(regular(Path::new("/dev/zero"), "read").is_err());
        }
    }
}
