//! The content of a folder of solutions and tiles, for listing and removing entries.

use orogen_io::read_at::PositionedFile;
use std::io;
use std::path::PathBuf;
use std::time::SystemTime;

use super::folder::FolderStore;
use super::{entry, tile_entry};
use orogen_grid::error::{Error, Result};
use orogen_grid::grid::Window;
use orogen_io::fs::{self, File};

/// A stored solution, or a stored tile of a level.
#[derive(Debug, Clone, PartialEq)]
pub struct Stored {
    /// The file.
    pub path: PathBuf,
    /// Its length in bytes.
    pub bytes: u64,
    /// The time of its last use.
    pub used: SystemTime,
    /// The windows of its layers or planes; `None` if its header is damaged.
    pub layers: Option<Vec<Window>>,
    /// The level, if it is a tile of a levelled op; `None` for a solution.
    pub level: Option<usize>,
}

impl FolderStore {
    /// The stored solutions and tiles, the least recently used first. Other files in the folder are ignored.
    ///
    /// # Errors
    /// If the folder exists and cannot be read.
    pub fn stored(&self) -> Result<Vec<Stored>> {
        let failed = |cause: io::Error| Error::file("read the folder", &self.folder, &cause);
        let there = match fs::read_dir(&self.folder) {
            Err(cause) if cause.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
            there => there.map_err(failed)?,
        };
        let mut stored = Vec::new();
        for file in there {
            let file = file.map_err(failed)?;
            let Some(key) = file.file_name().to_str().and_then(FolderStore::key_of) else { continue };
            // Another process may have removed it.
            let Ok(meta) = file.metadata() else { continue };
            if meta.is_file() {
                let path = file.path();
                let open = || File::open(&path).ok().map(PositionedFile::new);
                let tile = open().and_then(|file| tile_entry::windows(&file, &path, &key).ok());
                let (level, layers) = match tile {
                    Some((level, planes)) => (Some(level), Some(planes)),
                    None => (None, open().and_then(|file| entry::windows(Box::new(file), &path, &key.0).ok())),
                };
                let used = meta.modified().unwrap_or(SystemTime::UNIX_EPOCH);
                stored.push(Stored { path, bytes: meta.len(), used, layers, level });
            }
        }
        stored.sort_by(|a, b| (a.used, &a.path).cmp(&(b.used, &b.path)));
        Ok(stored)
    }

    /// Removes a stored solution or tile. It is not an error if the file no longer exists.
    ///
    /// # Errors
    /// If the file cannot be removed.
    pub fn remove(&self, stored: &Stored) -> Result<()> {
        match fs::remove_file(&stored.path) {
            Err(cause) if cause.kind() != io::ErrorKind::NotFound => Err(Error::file("remove", &stored.path, &cause)),
            _ => Ok(()),
        }
    }
}
