//! The only access to files: reading and writing recipes and the studio's own settings.
//!
//! In a browser these files are in memory, see [`crate::platform`].

use std::path::{Path, PathBuf};
use std::time::SystemTime;

use orogen::io::{fs, open};
use orogen::recipe::document::LONGEST_TEXT;
use orogen::{Error, ErrorKind, Result};

pub use crate::platform::{has_file_dialogs, settings_folder, working_folder};

/// Reads a text.
///
/// # Errors
/// If the file cannot be read, is too long for a recipe, or is not UTF-8.
pub fn read(path: &Path) -> Result<String> {
    let fault = |message: String| Error::new(ErrorKind::File, message);
    let bytes = open::bytes(path, "read", LONGEST_TEXT)?
        .ok_or_else(|| fault(format!("{} is too long for a recipe", path.display())))?;
    String::from_utf8(bytes).map_err(|_| fault(format!("{} is not a text in UTF-8", path.display())))
}

/// Writes a text atomically.
///
/// # Errors
/// If it cannot be written.
pub fn write(path: &Path, text: &str) -> Result<()> {
    write_bytes(path, text.as_bytes())
}

/// Writes bytes atomically.
///
/// # Errors
/// If they cannot be written.
pub fn write_bytes(path: &Path, bytes: &[u8]) -> Result<()> {
    if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        make_folder(folder)?;
    }
    orogen::io::file::replace_whole(path, |out| out.write_all(bytes))
}

/// Reads a small file; `None` if it cannot be read.
#[must_use]
pub fn read_bytes(path: &Path) -> Option<Vec<u8>> {
    open::bytes(path, "read", LONGEST_TEXT).ok()?
}

/// The path of the next version of a file: its name with a number that is greater than those of all versions beside it,
/// such as `land-002.toml` for `land-001.toml` or for `land.toml`.
#[must_use]
pub fn next_version(path: &Path) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let base = version(&stem).map_or(stem.as_str(), |(base, _)| base);
    let end = path.extension().map_or(String::new(), |end| format!(".{}", end.to_string_lossy()));
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let beside = fs::read_dir(folder).into_iter().flatten().flatten().filter_map(|entry| {
        let name = entry.file_name().to_string_lossy().into_owned();
        let (other, number) = version(name.strip_suffix(&end)?)?;
        (other == base).then_some(number)
    });
    let last = beside.max().unwrap_or(0);
    path.with_file_name(format!("{base}-{:03}{end}", last + 1))
}

/// The name and the number of a version: three digits or more after a hyphen.
fn version(stem: &str) -> Option<(&str, u32)> {
    let (base, digits) = stem.rsplit_once('-')?;
    let is_number = digits.len() >= 3 && digits.bytes().all(|digit| digit.is_ascii_digit());
    Some((base, digits.parse().ok().filter(|number| is_number && *number < u32::MAX)?))
}

/// Creates a folder and those around it, unless it exists.
///
/// # Errors
/// If it cannot be created.
pub fn make_folder(folder: &Path) -> Result<()> {
    fs::create_dir_all(folder).map_err(|cause| Error::file("create the folder", folder, &cause))
}

/// A locked file. The lock ends when this is dropped, or the process ends.
#[derive(Debug)]
pub struct Lock {
    _file: fs::File,
}

/// Locks a file, which is created if necessary; `None` if another process or window has the lock, or it cannot be
/// opened.
#[must_use]
pub fn lock(path: &Path) -> Option<Lock> {
    let file = fs::OpenOptions::new().create(true).truncate(false).read(true).write(true).open(path).ok()?;
    file.try_lock().ok().map(|()| Lock { _file: file })
}

/// What a question about an existing file or folder says.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct About {
    /// Its length in bytes; of a folder, the number of its entries.
    pub size: u64,
    /// Whether it is a folder.
    pub is_folder: bool,
    /// The time of its last change.
    pub changed: Option<SystemTime>,
}

/// Facts about a file, or about a folder with entries; `None` if there is none.
#[must_use]
pub fn about(path: &Path) -> Option<About> {
    let metadata = fs::metadata(path).ok()?;
    let entries = if metadata.is_dir() { fs::read_dir(path).ok()?.count() as u64 } else { 0 };
    let is_folder = metadata.is_dir();
    let size = if is_folder { entries } else { metadata.len() };
    (!is_folder || entries > 0).then(|| About { size, is_folder, changed: metadata.modified().ok() })
}

/// The time of the last change of a file; `None` if it does not exist.
#[must_use]
pub fn changed(path: &Path) -> Option<SystemTime> {
    fs::metadata(path).and_then(|metadata| metadata.modified()).ok()
}

/// Removes a file; it is not an error if it does not exist.
pub fn remove(path: &Path) {
    // A file that could not be removed is found again at the next start.
    let _ = fs::remove_file(path);
}

/// An entry of a folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Entry {
    /// The path.
    pub path: PathBuf,
    /// Whether it is a folder.
    pub is_folder: bool,
}

/// The entries of a folder: folders first, sorted by name; hidden entries are omitted.
///
/// # Errors
/// If the folder cannot be read.
pub fn list(folder: &Path) -> Result<Vec<Entry>> {
    let failed = |cause: std::io::Error| Error::file("read the folder", folder, &cause);
    let mut entries: Vec<Entry> = fs::read_dir(folder)
        .map_err(failed)?
        .flatten()
        .filter(|entry| !entry.file_name().to_string_lossy().starts_with('.'))
        .map(|entry| Entry { is_folder: entry.path().is_dir(), path: entry.path() })
        .collect();
    entries.sort_by(|a, b| b.is_folder.cmp(&a.is_folder).then_with(|| a.path.cmp(&b.path)));
    Ok(entries)
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen::io::test_folder::TestFolder;

    #[test]
    fn versions_are_numbered_on() {
        let folder = TestFolder::new("versions").unwrap();
        let path = |name: &str| folder.join(name);
        assert_eq!(next_version(&path("land.toml")), path("land-001.toml"));
        for name in ["land-001.toml", "land-007.toml", "land-0x8.toml", "other-099.toml", "land-050.json"] {
            write(&path(name), "").unwrap();
        }
        for name in ["land.toml", "land-001.toml", "land-007.toml"] {
            assert_eq!(next_version(&path(name)), path("land-008.toml"), "{name}");
        }
        assert_eq!(next_version(&path("route-66.toml")), path("route-66-001.toml"), "two digits are a name");
        assert_eq!(next_version(Path::new("nowhere/a.toml")), Path::new("nowhere/a-001.toml"));
    }
}
