//! The items of `std::fs` that Orogen uses, for a host without a file system.
//!
//! No file can be opened, so a [`File`] never exists. Its methods compile but are never called.

use std::convert::Infallible;
use std::ffi::OsString;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// The error that every operation returns.
fn no<T>() -> io::Result<T> {
    Err(io::Error::new(io::ErrorKind::Unsupported, "this build has no file system: its feature `fs` is off"))
}

/// An open file.
#[derive(Debug)]
pub struct File(Infallible);

/// Options for opening a file.
#[derive(Debug, Clone, Default)]
pub struct OpenOptions;

/// Metadata of a file.
#[derive(Debug, Clone)]
pub struct Metadata(Infallible);

/// Permissions of a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Permissions(Infallible);

/// The type of an entry: file, folder or link.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct FileType(Infallible);

/// A file or folder inside a folder.
#[derive(Debug)]
pub struct DirEntry(Infallible);

/// An iterator over the files and folders inside a folder.
#[derive(Debug)]
pub struct ReadDir(Infallible);

/// The reason why a file could not be locked.
#[derive(Debug)]
pub enum TryLockError {
    /// Another error.
    Error(io::Error),
    /// Another process holds the lock.
    WouldBlock,
}

#[allow(missing_docs, clippy::missing_errors_doc, reason = "as in std::fs")]
impl File {
    pub fn open(_: impl AsRef<Path>) -> io::Result<File> {
        no()
    }

    pub fn create(_: impl AsRef<Path>) -> io::Result<File> {
        no()
    }

    #[must_use]
    pub fn options() -> OpenOptions {
        OpenOptions
    }

    pub fn metadata(&self) -> io::Result<Metadata> {
        match self.0 {}
    }

    pub fn set_permissions(&self, _: Permissions) -> io::Result<()> {
        match self.0 {}
    }

    pub fn set_modified(&self, _: SystemTime) -> io::Result<()> {
        match self.0 {}
    }

    pub fn set_len(&self, _: u64) -> io::Result<()> {
        match self.0 {}
    }

    pub fn sync_all(&self) -> io::Result<()> {
        match self.0 {}
    }

    pub fn sync_data(&self) -> io::Result<()> {
        match self.0 {}
    }

    pub fn try_lock(&self) -> Result<(), TryLockError> {
        match self.0 {}
    }

    pub fn try_lock_shared(&self) -> Result<(), TryLockError> {
        match self.0 {}
    }
}

macro_rules! streams {
    ($($file:ty),+) => {$(
        impl Read for $file {
            fn read(&mut self, _: &mut [u8]) -> io::Result<usize> {
                match self.0 {}
            }
        }

        impl Write for $file {
            fn write(&mut self, _: &[u8]) -> io::Result<usize> {
                match self.0 {}
            }

            fn flush(&mut self) -> io::Result<()> {
                match self.0 {}
            }
        }

        impl Seek for $file {
            fn seek(&mut self, _: SeekFrom) -> io::Result<u64> {
                match self.0 {}
            }
        }
    )+};
}

streams!(File, &File);

#[allow(missing_docs, clippy::missing_errors_doc, reason = "as in std::fs")]
impl OpenOptions {
    #[must_use]
    pub fn new() -> OpenOptions {
        OpenOptions
    }

    pub fn read(&mut self, _: bool) -> &mut OpenOptions {
        self
    }

    pub fn write(&mut self, _: bool) -> &mut OpenOptions {
        self
    }

    pub fn append(&mut self, _: bool) -> &mut OpenOptions {
        self
    }

    pub fn create(&mut self, _: bool) -> &mut OpenOptions {
        self
    }

    pub fn create_new(&mut self, _: bool) -> &mut OpenOptions {
        self
    }

    pub fn truncate(&mut self, _: bool) -> &mut OpenOptions {
        self
    }

    pub fn open(&self, _: impl AsRef<Path>) -> io::Result<File> {
        no()
    }
}

#[allow(missing_docs, clippy::missing_errors_doc, clippy::len_without_is_empty, reason = "as in std::fs")]
impl Metadata {
    #[must_use]
    pub fn is_file(&self) -> bool {
        match self.0 {}
    }

    #[must_use]
    pub fn is_dir(&self) -> bool {
        match self.0 {}
    }

    #[must_use]
    pub fn is_symlink(&self) -> bool {
        match self.0 {}
    }

    #[must_use]
    pub fn len(&self) -> u64 {
        match self.0 {}
    }

    #[must_use]
    pub fn permissions(&self) -> Permissions {
        match self.0 {}
    }

    pub fn modified(&self) -> io::Result<SystemTime> {
        match self.0 {}
    }
}

#[allow(missing_docs, reason = "as in std::fs")]
impl Permissions {
    #[must_use]
    pub fn readonly(&self) -> bool {
        match self.0 {}
    }
}

#[allow(missing_docs, reason = "as in std::fs")]
impl FileType {
    #[must_use]
    pub fn is_file(&self) -> bool {
        match self.0 {}
    }

    #[must_use]
    pub fn is_dir(&self) -> bool {
        match self.0 {}
    }
}

#[allow(missing_docs, clippy::missing_errors_doc, reason = "as in std::fs")]
impl DirEntry {
    #[must_use]
    pub fn path(&self) -> PathBuf {
        match self.0 {}
    }

    #[must_use]
    pub fn file_name(&self) -> OsString {
        match self.0 {}
    }

    pub fn file_type(&self) -> io::Result<FileType> {
        match self.0 {}
    }

    pub fn metadata(&self) -> io::Result<Metadata> {
        match self.0 {}
    }
}

impl Iterator for ReadDir {
    type Item = io::Result<DirEntry>;

    fn next(&mut self) -> Option<io::Result<DirEntry>> {
        match self.0 {}
    }
}

/// Whether a path names an object of a store; never.
#[must_use]
pub fn is_remote(_: impl AsRef<Path>) -> bool {
    false
}

/// Whether a path names a file on an HTTP server; never.
#[must_use]
pub fn is_read_only(_: &Path) -> bool {
    false
}

macro_rules! functions {
    ($($name:ident($($argument:ident),+) -> $made:ty;)+) => {$(
        #[doc = concat!("As `std::fs::", stringify!($name), "`.\n\n# Errors\nAlways.")]
        pub fn $name($($argument: impl AsRef<Path>),+) -> io::Result<$made> {
            $(let _ = $argument;)+
            no()
        }
    )+};
}

functions! {
    canonicalize(path) -> PathBuf;
    create_dir(path) -> ();
    create_dir_all(path) -> ();
    hard_link(from, to) -> ();
    metadata(path) -> Metadata;
    read(path) -> Vec<u8>;
    read_dir(path) -> ReadDir;
    read_to_string(path) -> String;
    remove_dir(path) -> ();
    remove_dir_all(path) -> ();
    remove_file(path) -> ();
    rename(from, to) -> ();
    symlink_metadata(path) -> Metadata;
}

/// Writes a file that must not exist.
///
/// # Errors
/// Always.
pub fn write_new(_: impl AsRef<Path>, _: impl AsRef<[u8]>) -> io::Result<()> {
    no()
}

/// Like `std::fs::write`.
///
/// # Errors
/// Always.
pub fn write(_: impl AsRef<Path>, _: impl AsRef<[u8]>) -> io::Result<()> {
    no()
}
