//! A file that a recipe names, and its content.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::prepared::PreparedDem;
use orogen_grid::error::Location;

/// A file of heights named by a recipe. Its content is read once, when the world is opened.
#[derive(Debug, Clone, Default)]
pub struct FileRef {
    path: String,
    folder: Option<PathBuf>,
    ground: Option<Arc<PreparedDem>>,
    picture: bool,
    /// The location in the recipe's text that names it.
    location: Option<Box<Location>>,
}

/// A greyscale picture named by a recipe: its content is numbers from 0 for black to 1 for white, one metre apart.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture(pub FileRef);

impl Default for Picture {
    fn default() -> Picture {
        Picture::from("")
    }
}

impl From<&str> for Picture {
    fn from(path: &str) -> Picture {
        Picture(FileRef { picture: true, ..FileRef::from(path) })
    }
}

/// Equality compares the names of the files, not their content.
impl PartialEq for FileRef {
    fn eq(&self, other: &FileRef) -> bool {
        self.path() == other.path()
    }
}

impl From<&str> for FileRef {
    fn from(path: &str) -> FileRef {
        FileRef { path: path.to_string(), ..FileRef::default() }
    }
}

impl FileRef {
    /// Whether no file is named.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.path.is_empty()
    }

    /// Whether the file is read as a picture instead of heights.
    #[must_use]
    pub fn is_picture(&self) -> bool {
        self.picture
    }

    /// The path: a relative one is relative to the folder of the recipe or, if the recipe is not a file, to the working
    /// folder.
    #[must_use]
    pub fn path(&self) -> PathBuf {
        match &self.folder {
            Some(folder) => folder.join(&self.path),
            None => PathBuf::from(&self.path),
        }
    }

    /// The name in a recipe that may be stored in any folder.
    #[must_use]
    pub fn text(&self) -> String {
        match &self.folder {
            Some(_) => std::path::absolute(self.path()).unwrap_or_else(|_| self.path()).display().to_string(),
            None => self.path.clone(),
        }
    }

    /// Sets the folder of the recipe.
    pub fn set_base_dir(&mut self, folder: &Path) {
        self.folder = Some(folder.to_path_buf());
    }

    /// The location in the recipe's text that names it, if there is one.
    #[must_use]
    pub fn location(&self) -> Option<&Location> {
        self.location.as_deref()
    }

    /// Sets the location in the recipe's text.
    pub fn set_location(&mut self, location: Location) {
        self.location = Some(Box::new(location));
    }

    /// The content, if it was read.
    #[must_use]
    pub fn ground(&self) -> Option<&Arc<PreparedDem>> {
        self.ground.as_ref()
    }

    /// Sets the content.
    pub fn hold(&mut self, ground: Arc<PreparedDem>) {
        self.ground = Some(ground);
    }
}
