//! What is known of files and folders without opening them.

use std::ffi::OsString;
use std::fs as system;
use std::io;
use std::path::PathBuf;
use std::time::SystemTime;

use super::super::objects::{ObjectEntry, ObjectInfo};
use super::unsupported;

/// Metadata of a file.
#[derive(Debug, Clone)]
pub struct Metadata(pub(super) About);

#[derive(Debug, Clone)]
pub(super) enum About {
    Local(system::Metadata),
    /// An object, or a folder of objects.
    Remote(Option<ObjectInfo>),
}

/// Permissions of a file; an object has none.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Permissions(pub(super) Option<system::Permissions>);

/// The type of an entry: file, folder or link.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum FileType {
    /// As in `std::fs`.
    Local(system::FileType),
    /// An object, or a folder of objects.
    Remote {
        /// Whether it is a folder.
        is_dir: bool,
    },
}

/// A file or folder inside a folder.
#[derive(Debug)]
pub struct DirEntry(Listed);

#[derive(Debug)]
enum Listed {
    Local(system::DirEntry),
    Remote(PathBuf, ObjectEntry),
}

/// An iterator over the files and folders inside a folder.
#[derive(Debug)]
pub struct ReadDir(pub(super) Listing);

#[derive(Debug)]
pub(super) enum Listing {
    Local(system::ReadDir),
    Remote(PathBuf, std::vec::IntoIter<ObjectEntry>),
}

#[allow(missing_docs, clippy::missing_errors_doc, clippy::len_without_is_empty, reason = "as in std::fs")]
impl Metadata {
    #[must_use]
    pub fn is_file(&self) -> bool {
        match &self.0 {
            About::Local(about) => about.is_file(),
            About::Remote(object) => object.is_some(),
        }
    }

    #[must_use]
    pub fn is_dir(&self) -> bool {
        match &self.0 {
            About::Local(about) => about.is_dir(),
            About::Remote(object) => object.is_none(),
        }
    }

    #[must_use]
    pub fn is_symlink(&self) -> bool {
        match &self.0 {
            About::Local(about) => about.is_symlink(),
            About::Remote(_) => false,
        }
    }

    #[must_use]
    pub fn len(&self) -> u64 {
        match &self.0 {
            About::Local(about) => about.len(),
            About::Remote(object) => object.as_ref().map_or(0, |object| object.length),
        }
    }

    #[must_use]
    pub fn permissions(&self) -> Permissions {
        match &self.0 {
            About::Local(about) => Permissions(Some(about.permissions())),
            About::Remote(_) => Permissions(None),
        }
    }

    pub fn modified(&self) -> io::Result<SystemTime> {
        match &self.0 {
            About::Local(about) => about.modified(),
            About::Remote(Some(object)) => Ok(object.changed),
            About::Remote(None) => unsupported("a folder of objects has no time"),
        }
    }

    /// The numbers of the device and of the file, which hard links share; `None` for an object.
    #[cfg(unix)]
    #[must_use]
    pub fn number(&self) -> Option<[u64; 2]> {
        use std::os::unix::fs::MetadataExt;
        match &self.0 {
            About::Local(about) => Some([about.dev(), about.ino()]),
            About::Remote(_) => None,
        }
    }
}

#[allow(missing_docs, reason = "as in std::fs")]
impl Permissions {
    #[must_use]
    pub fn readonly(&self) -> bool {
        self.0.as_ref().is_some_and(system::Permissions::readonly)
    }
}

#[allow(missing_docs, reason = "as in std::fs")]
impl FileType {
    #[must_use]
    pub fn is_file(&self) -> bool {
        match self {
            FileType::Local(kind) => kind.is_file(),
            FileType::Remote { is_dir } => !is_dir,
        }
    }

    #[must_use]
    pub fn is_dir(&self) -> bool {
        match self {
            FileType::Local(kind) => kind.is_dir(),
            FileType::Remote { is_dir } => *is_dir,
        }
    }
}

#[allow(missing_docs, clippy::missing_errors_doc, reason = "as in std::fs")]
impl DirEntry {
    #[must_use]
    pub fn path(&self) -> PathBuf {
        match &self.0 {
            Listed::Local(entry) => entry.path(),
            Listed::Remote(folder, entry) => folder.join(&entry.name),
        }
    }

    #[must_use]
    pub fn file_name(&self) -> OsString {
        match &self.0 {
            Listed::Local(entry) => entry.file_name(),
            Listed::Remote(_, entry) => OsString::from(&entry.name),
        }
    }

    pub fn file_type(&self) -> io::Result<FileType> {
        Ok(match &self.0 {
            Listed::Local(entry) => FileType::Local(entry.file_type()?),
            Listed::Remote(_, entry) => FileType::Remote { is_dir: entry.object.is_none() },
        })
    }

    pub fn metadata(&self) -> io::Result<Metadata> {
        Ok(Metadata(match &self.0 {
            Listed::Local(entry) => About::Local(entry.metadata()?),
            Listed::Remote(_, entry) => About::Remote(entry.object.clone()),
        }))
    }
}

impl Iterator for ReadDir {
    type Item = io::Result<DirEntry>;

    fn next(&mut self) -> Option<io::Result<DirEntry>> {
        match &mut self.0 {
            Listing::Local(entries) => Some(entries.next()?.map(|entry| DirEntry(Listed::Local(entry)))),
            Listing::Remote(folder, entries) => Some(Ok(DirEntry(Listed::Remote(folder.clone(), entries.next()?)))),
        }
    }
}
