//! The folder that a terrain is written into.

use std::path::{Path, PathBuf};

use orogen::{Error, file};

use crate::failure::Failure;

/// A folder that takes files. What had to be made of it is removed again when dropped, unless something was put in or
/// [`Folder::keep`] was called: what fails leaves no trace.
#[derive(Debug)]
pub struct Folder {
    made: Vec<PathBuf>,
}

impl Folder {
    /// Makes sure of the folder at `path`: better to hear of one that takes no files before the work than after it.
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

    /// It has got what it was made for.
    pub fn keep(mut self) {
        self.made.clear();
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        for path in &self.made {
            // Removes only what is empty.
            let _ = std::fs::remove_dir(path);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_made_goes_unless_kept_or_filled() {
        let root = std::env::temp_dir().join(format!("orogen-folder-{}", std::process::id()));
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
        std::fs::remove_dir_all(&root).unwrap();
    }
}
