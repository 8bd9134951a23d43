//! The only access to files: reading and writing recipes and the studio's own settings.
//!
//! The rest of the studio works on texts and values, so a build for a browser only needs a replacement of this file.

use std::path::{Path, PathBuf};
use std::time::SystemTime;

use orogen::io::open;
use orogen::recipe::document::LONGEST_TEXT;
use orogen::{Error, ErrorKind, Result};

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
    if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        std::fs::create_dir_all(folder).map_err(|cause| Error::file("create the folder", folder, &cause))?;
    }
    orogen::io::file::replace_whole(path, |out| out.write_all(text.as_bytes()))
}

/// The time of the last change of a file; `None` if it does not exist.
#[must_use]
pub fn changed(path: &Path) -> Option<SystemTime> {
    std::fs::metadata(path).and_then(|metadata| metadata.modified()).ok()
}

/// Removes a file; it is not an error if it does not exist.
pub fn remove(path: &Path) {
    // A file that could not be removed is found again at the next start.
    let _ = std::fs::remove_file(path);
}

/// The folder of the studio's settings: `orogen` in the system's settings folder; `None` if the system has none.
#[must_use]
pub fn settings_folder() -> Option<PathBuf> {
    let var = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    let base = if cfg!(windows) {
        var("APPDATA")
    } else if cfg!(target_os = "macos") {
        var("HOME").map(|home| home.join("Library/Application Support"))
    } else {
        var("XDG_CONFIG_HOME").or_else(|| var("HOME").map(|home| home.join(".config")))
    };
    base.map(|base| base.join("orogen"))
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
    let mut entries: Vec<Entry> = std::fs::read_dir(folder)
        .map_err(failed)?
        .flatten()
        .filter(|entry| !entry.file_name().to_string_lossy().starts_with('.'))
        .map(|entry| Entry { is_folder: entry.path().is_dir(), path: entry.path() })
        .collect();
    entries.sort_by(|a, b| b.is_folder.cmp(&a.is_folder).then_with(|| a.path.cmp(&b.path)));
    Ok(entries)
}

/// The working folder.
#[must_use]
pub fn working_folder() -> PathBuf {
    std::env::current_dir().unwrap_or_default()
}
