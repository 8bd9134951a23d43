//! The files of a folder with the studio and the book, as `cargo xtask web` and `cargo xtask book` make it.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use orogen::{Error, ErrorKind};

/// The parts of the folder that are served.
pub const PARTS: [&str; 2] = ["studio", "book"];

/// Maximum number of files.
const MAX_FILES: usize = 100_000;

/// The files of a folder. Requests look names up in this list and never make a path.
#[derive(Debug, Default)]
pub struct Site {
    files: BTreeMap<String, PathBuf>,
}

impl Site {
    /// Lists the files of the parts that a folder has. Links are not followed.
    ///
    /// # Errors
    /// If the folder has none of the parts, cannot be read, or has too many files.
    pub fn of(folder: &Path) -> orogen::Result<Site> {
        let mut files = BTreeMap::new();
        let mut open: Vec<(String, PathBuf)> = PARTS
            .map(|part| (part.to_string(), folder.join(part)))
            .into_iter()
            .filter(|(_, path)| path.is_dir())
            .collect();
        if open.is_empty() {
            let message = format!(
                "{} has neither a folder `studio` nor a folder `book`; `cargo xtask web` and `cargo xtask book` make them",
                folder.display()
            );
            return Err(Error::new(ErrorKind::Request, message));
        }
        while let Some((name, path)) = open.pop() {
            let failed = |cause: std::io::Error| Error::file("read the folder", &path, &cause);
            for entry in std::fs::read_dir(&path).map_err(failed)? {
                let entry = entry.map_err(failed)?;
                let Ok(own) = entry.file_name().into_string() else { continue };
                let kind = entry.file_type().map_err(failed)?;
                let name = format!("{name}/{own}");
                if kind.is_dir() {
                    open.push((name, entry.path()));
                } else if kind.is_file() {
                    files.insert(name, entry.path());
                }
            }
            if files.len() > MAX_FILES {
                let message = format!("{} has more than {MAX_FILES} files, too many for pages", folder.display());
                return Err(Error::new(ErrorKind::Request, message));
            }
        }
        Ok(Site { files })
    }

    /// The path of a file, by its name such as `studio/index.html`.
    pub fn find(&self, name: &str) -> Option<&Path> {
        self.files.get(name).map(PathBuf::as_path)
    }

    /// Whether it has a part.
    pub fn has(&self, part: &str) -> bool {
        self.files.contains_key(&format!("{part}/index.html"))
    }
}
