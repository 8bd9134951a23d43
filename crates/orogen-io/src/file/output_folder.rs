//! Folders for results.

use std::path::{Path, PathBuf};

use super::atomic::check_folder;
use crate::fs;
use orogen_grid::error::{Error, Result};

/// A writable folder. Folders created for it are removed on drop if they are empty and [`OutputFolder::keep`] was not
/// called, so that failed work leaves no trace.
#[derive(Debug)]
pub struct OutputFolder {
    made: Vec<PathBuf>,
}

impl OutputFolder {
    /// Checks that files can be written to the folder at `path`, before the work begins; creates it if needed.
    ///
    /// # Errors
    /// If it cannot be created, or does not accept files.
    pub fn ready(path: &Path) -> Result<OutputFolder> {
        let missing = |path: &&Path| !path.as_os_str().is_empty() && fs::symlink_metadata(path).is_err();
        let made = path.ancestors().take_while(missing).map(Path::to_path_buf).collect::<Vec<_>>();
        let folder = OutputFolder { made };
        if !folder.made.is_empty() {
            fs::create_dir_all(path).map_err(|cause| Error::file("make the folder", path, &cause))?;
        }
        check_folder(path)?;
        Ok(folder)
    }

    /// Keeps the folder.
    pub fn keep(mut self) {
        self.made.clear();
    }
}

impl Drop for OutputFolder {
    fn drop(&mut self) {
        for path in &self.made {
            // Removes only empty folders.
            let _ = fs::remove_dir(path);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_folder::TestFolder;

    #[test]
    fn what_was_made_goes_unless_kept_or_filled() {
        let parent = TestFolder::new("folder").unwrap();
        let root = parent.join("root");
        let deep = root.join("a/b");
        drop(OutputFolder::ready(&deep).unwrap());
        assert!(!root.exists());
        let folder = OutputFolder::ready(&deep).unwrap();
        fs::write(root.join("a/mine"), "x").unwrap();
        drop(folder);
        assert!(!deep.exists() && root.join("a/mine").exists());
        OutputFolder::ready(&deep).unwrap().keep();
        drop(OutputFolder::ready(&deep).unwrap());
        assert!(deep.exists());
    }
}
