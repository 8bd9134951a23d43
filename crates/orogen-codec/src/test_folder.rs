//! A folder for the files of a test.

use std::io;
use std::ops::Deref;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use crate::fs;

/// A new, empty folder in the system's temporary folder. It is removed with its contents on drop.
#[derive(Debug)]
pub struct TestFolder {
    path: PathBuf,
}

impl TestFolder {
    /// A folder whose name contains `name`.
    ///
    /// # Errors
    /// If the folder cannot be created.
    pub fn new(name: &str) -> io::Result<TestFolder> {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        let count = COUNT.fetch_add(1, Ordering::Relaxed);
        let path = std::env::temp_dir().join(format!("orogen-{name}-{}-{count}", std::process::id()));
        // A killed process with the same number may have left a folder.
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path)?;
        Ok(TestFolder { path })
    }

    /// The names of the files and folders in the folder, sorted.
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.path).into_iter().flatten().flatten();
        let mut names: Vec<String> = entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }
}

impl Deref for TestFolder {
    type Target = Path;

    fn deref(&self) -> &Path {
        &self.path
    }
}

impl AsRef<Path> for TestFolder {
    fn as_ref(&self) -> &Path {
        &self.path
    }
}

impl Drop for TestFolder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.path);
    }
}
