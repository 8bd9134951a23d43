//! Identity of files: whether two paths refer to the same file.

use std::path::{Path, PathBuf};

use crate::fs;

/// The identity of a file, independent of names and links.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FileId {
    /// The path with links resolved: the identity on systems without file numbers, and the name in messages on others.
    real: PathBuf,
    /// Device and file number, which hard links share; objects have none.
    #[cfg(all(unix, feature = "fs"))]
    number: Option<[u64; 2]>,
}

impl FileId {
    /// The file at `path`; `None` if there is none, or if it is a folder, a pipe or a device.
    pub fn of(path: &Path) -> Option<FileId> {
        let there = fs::metadata(path).ok().filter(fs::Metadata::is_file)?;
        let real = fs::canonicalize(path).ok()?;
        #[cfg(all(unix, feature = "fs"))]
        {
            Some(FileId { real, number: there.number() })
        }
        #[cfg(not(all(unix, feature = "fs")))]
        {
            let _ = there;
            Some(FileId { real })
        }
    }

    /// Whether both are the same file.
    pub fn is(&self, other: &FileId) -> bool {
        #[cfg(all(unix, feature = "fs"))]
        if self.number.is_some() && self.number == other.number {
            return true;
        }
        self.real == other.real
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_lead_to_the_same_file() {
        let folder = std::env::temp_dir().join(format!("orogen-identity-{}", std::process::id()));
        fs::create_dir_all(folder.join("in")).unwrap();
        let path = |name: &str| folder.join(name);
        fs::write(path("a"), "same").unwrap();
        fs::write(path("b"), "same").unwrap();
        fs::hard_link(path("a"), path("hard")).unwrap();
        let a = FileId::of(&path("a")).unwrap();
        assert!(a.is(&FileId::of(&path("in/../a")).unwrap()));
        assert!(!a.is(&FileId::of(&path("b")).unwrap()));
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink("a", path("soft")).unwrap();
            assert!(a.is(&FileId::of(&path("soft")).unwrap()) && a.is(&FileId::of(&path("hard")).unwrap()));
            assert_eq!(FileId::of(Path::new("/dev/null")), None);
        }
        assert_eq!((FileId::of(&path("in")), FileId::of(&path("none"))), (None, None));
        fs::remove_dir_all(&folder).unwrap();
    }
}
