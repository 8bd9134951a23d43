//! The output folder of a terrain.

use std::path::{Path, PathBuf};

use orogen::{Error, file};

use crate::failure::Failure;

/// A writable folder. Folders created for it are removed on drop if they are empty and [`Folder::keep`] was not called,
/// so that a failed command leaves no trace.
#[derive(Debug)]
pub struct Folder {
    made: Vec<PathBuf>,
}

impl Folder {
    /// Checks that files can be written to the folder at `path`, before the work begins; creates it if needed.
    pub fn ready(path: &Path) -> Result<Folder, Failure> {
        let missing = |path: &&Path| !path.as_os_str().is_empty() && path.symlink_metadata().is_err();
        let made = path.ancestors().take_while(missing).map(Path::to_path_buf).collect::<Vec<_>>();
        let folder = Folder { made };
        if !folder.made.is_empty() {
            std::fs::create_dir_all(path).map_err(|cause| Error::file("make the folder", path, &cause))?;
        }
        file::check_folder(path)?;
        Ok(folder)
    }

    /// Keeps the folder.
    pub fn keep(mut self) {
        self.made.clear();
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        for path in &self.made {
            // Removes only empty folders.
            let _ = std::fs::remove_dir(path);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen::test_folder::TestFolder;

    #[test]
    fn what_was_made_goes_unless_kept_or_filled() {
        let parent = TestFolder::new("folder").unwrap();
        let root = parent.join("root");
        let deep = root.join("a/b");
        drop(Folder::ready(&deep).unwrap());
        assert!(!root.exists());
        let folder = Folder::ready(&deep).unwrap();
        std::fs::write(root.join("a/mine"), "x").unwrap();
        drop(folder);
        assert!(!deep.exists() && root.join("a/mine").exists());
        Folder::ready(&deep).unwrap().keep();
        drop(Folder::ready(&deep).unwrap());
        assert!(deep.exists());
    }
}
