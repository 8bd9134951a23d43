//! A file that a recipe names, and what was read of it.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::prepared::PreparedDem;
use orogen_grid::error::Location;

/// A file of heights named by a recipe. What is in it is read once, when the world is opened.
#[derive(Debug, Clone, Default)]
pub struct FileRef {
    path: String,
    folder: Option<PathBuf>,
    ground: Option<Arc<PreparedDem>>,
    picture: bool,
    /// Where a recipe's text names it.
    location: Option<Box<Location>>,
}

/// A grey picture named by a recipe: what is read of it are numbers from 0 for black to 1 for white, a metre apart.
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

/// Two are the same if they name the same file: what was read of it makes no difference.
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
    pub fn is_empty(&self) -> bool {
        self.path.is_empty()
    }

    /// Whether it is read as a picture, not as heights.
    pub fn is_picture(&self) -> bool {
        self.picture
    }

    /// Where the file is: a relative path counts from the folder of the recipe, or, of a recipe that is no file, from the working folder.
    pub fn path(&self) -> PathBuf {
        match &self.folder {
            Some(folder) => folder.join(&self.path),
            None => PathBuf::from(&self.path),
        }
    }

    /// What a recipe that may lie anywhere calls it.
    pub fn text(&self) -> String {
        match &self.folder {
            Some(_) => std::path::absolute(self.path()).unwrap_or_else(|_| self.path()).display().to_string(),
            None => self.path.clone(),
        }
    }

    /// Says which folder the recipe lies in.
    pub fn set_base_dir(&mut self, folder: &Path) {
        self.folder = Some(folder.to_path_buf());
    }

    /// Where a recipe's text names it, if one does.
    pub fn location(&self) -> Option<&Location> {
        self.location.as_deref()
    }

    /// Says where a recipe's text names it.
    pub fn set_location(&mut self, location: Location) {
        self.location = Some(Box::new(location));
    }

    /// What was read of it.
    pub fn ground(&self) -> Option<&Arc<PreparedDem>> {
        self.ground.as_ref()
    }

    /// Takes what was read of it.
    pub fn hold(&mut self, ground: Arc<PreparedDem>) {
        self.ground = Some(ground);
    }
}
