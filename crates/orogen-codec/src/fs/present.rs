//! The items of `std::fs` that Orogen uses, for files of the system and for [objects](super::objects).

use std::ffi::OsString;
use std::fs as system;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use super::objects::{self, ObjectEntry, ObjectInfo, RemoteFile, is_remote, url};

pub use system::TryLockError;

/// An open file.
#[derive(Debug)]
pub struct File(Opened);

#[derive(Debug)]
enum Opened {
    Local(system::File),
    Remote(Box<RemoteFile>),
}

impl From<system::File> for File {
    fn from(file: system::File) -> File {
        File(Opened::Local(file))
    }
}

/// Options for opening a file.
#[derive(Debug, Clone)]
pub struct OpenOptions {
    local: system::OpenOptions,
    writes: bool,
    appends: bool,
    creates: bool,
    replaces: bool,
}

/// Metadata of a file.
#[derive(Debug, Clone)]
pub struct Metadata(About);

#[derive(Debug, Clone)]
enum About {
    Local(system::Metadata),
    /// An object, or a folder of objects.
    Remote(Option<ObjectInfo>),
}

/// Permissions of a file; an object has none.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Permissions(Option<system::Permissions>);

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
pub struct ReadDir(Listing);

#[derive(Debug)]
enum Listing {
    Local(system::ReadDir),
    Remote(PathBuf, std::vec::IntoIter<ObjectEntry>),
}

/// The error for what objects do not have.
fn unsupported<T>(why: &str) -> io::Result<T> {
    Err(io::Error::new(io::ErrorKind::Unsupported, why))
}

#[allow(missing_docs, clippy::missing_errors_doc, reason = "as in std::fs")]
impl File {
    pub fn open(path: impl AsRef<Path>) -> io::Result<File> {
        let path = path.as_ref();
        Ok(File(match is_remote(path) {
            true => Opened::Remote(Box::new(RemoteFile::open(path)?)),
            false => Opened::Local(system::File::open(path)?),
        }))
    }

    pub fn create(path: impl AsRef<Path>) -> io::Result<File> {
        OpenOptions::new().write(true).create(true).truncate(true).open(path)
    }

    #[must_use]
    pub fn options() -> OpenOptions {
        OpenOptions::new()
    }

    pub fn metadata(&self) -> io::Result<Metadata> {
        Ok(Metadata(match &self.0 {
            Opened::Local(file) => About::Local(file.metadata()?),
            Opened::Remote(file) => About::Remote(Some(file.info().clone())),
        }))
    }

    pub fn set_permissions(&self, permissions: Permissions) -> io::Result<()> {
        match (&self.0, permissions.0) {
            (Opened::Local(file), Some(permissions)) => file.set_permissions(permissions),
            _ => Ok(()),
        }
    }

    pub fn set_modified(&self, time: SystemTime) -> io::Result<()> {
        match &self.0 {
            Opened::Local(file) => file.set_modified(time),
            Opened::Remote(_) => unsupported("the time of an object cannot be set"),
        }
    }

    pub fn set_len(&self, length: u64) -> io::Result<()> {
        match &self.0 {
            Opened::Local(file) => file.set_len(length),
            Opened::Remote(_) => unsupported("an object is written whole"),
        }
    }

    pub fn sync_all(&self) -> io::Result<()> {
        match &self.0 {
            Opened::Local(file) => file.sync_all(),
            Opened::Remote(file) => file.sync(),
        }
    }

    pub fn sync_data(&self) -> io::Result<()> {
        match &self.0 {
            Opened::Local(file) => file.sync_data(),
            Opened::Remote(file) => file.sync(),
        }
    }

    pub fn try_lock(&self) -> Result<(), TryLockError> {
        match &self.0 {
            Opened::Local(file) => file.try_lock(),
            Opened::Remote(_) => Ok(()),
        }
    }

    pub fn try_lock_shared(&self) -> Result<(), TryLockError> {
        match &self.0 {
            Opened::Local(file) => file.try_lock_shared(),
            Opened::Remote(_) => Ok(()),
        }
    }

    /// The file of the system; `None` for an object.
    #[cfg(not(any(unix, windows)))]
    pub(crate) fn local(&self) -> Option<&system::File> {
        match &self.0 {
            Opened::Local(file) => Some(file),
            Opened::Remote(_) => None,
        }
    }

    /// Fills `bytes` with the bytes from offset `at` on, without moving the position.
    #[cfg(any(unix, windows))]
    pub(crate) fn read_exact_at(&self, at: u64, bytes: &mut [u8]) -> io::Result<()> {
        match &self.0 {
            Opened::Local(file) => positioned::read_exact_at(file, at, bytes),
            Opened::Remote(file) => file.read_exact_at(at, bytes),
        }
    }

    /// Writes all of `bytes` from offset `at` on, without moving the position.
    #[cfg(any(unix, windows))]
    pub(crate) fn write_all_at(&self, at: u64, bytes: &[u8]) -> io::Result<()> {
        match &self.0 {
            Opened::Local(file) => positioned::write_all_at(file, at, bytes),
            Opened::Remote(_) => unsupported("an object is written whole"),
        }
    }
}

#[cfg(unix)]
mod positioned {
    use std::fs::File;
    use std::io;
    use std::os::unix::fs::FileExt;

    pub fn read_exact_at(file: &File, at: u64, bytes: &mut [u8]) -> io::Result<()> {
        file.read_exact_at(bytes, at)
    }

    pub fn write_all_at(file: &File, at: u64, bytes: &[u8]) -> io::Result<()> {
        file.write_all_at(bytes, at)
    }
}

#[cfg(windows)]
mod positioned {
    use std::fs::File;
    use std::io;
    use std::os::windows::fs::FileExt;

    pub fn write_all_at(file: &File, at: u64, bytes: &[u8]) -> io::Result<()> {
        let mut done = 0;
        while done < bytes.len() {
            match file.seek_write(&bytes[done..], at + done as u64) {
                Ok(0) => return Err(io::ErrorKind::WriteZero.into()),
                Ok(count) => done += count,
                Err(cause) if cause.kind() == io::ErrorKind::Interrupted => {}
                Err(cause) => return Err(cause),
            }
        }
        Ok(())
    }

    pub fn read_exact_at(file: &File, at: u64, bytes: &mut [u8]) -> io::Result<()> {
        let mut done = 0;
        while done < bytes.len() {
            match file.seek_read(&mut bytes[done..], at + done as u64) {
                Ok(0) => return Err(io::ErrorKind::UnexpectedEof.into()),
                Ok(count) => done += count,
                Err(cause) if cause.kind() == io::ErrorKind::Interrupted => {}
                Err(cause) => return Err(cause),
            }
        }
        Ok(())
    }
}

macro_rules! streams {
    ($($file:ty),+) => {$(
        impl Read for $file {
            fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
                match &self.0 {
                    Opened::Local(file) => (&*file).read(bytes),
                    Opened::Remote(file) => file.read(bytes),
                }
            }
        }

        impl Write for $file {
            fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
                match &self.0 {
                    Opened::Local(file) => (&*file).write(bytes),
                    Opened::Remote(file) => file.write(bytes),
                }
            }

            fn flush(&mut self) -> io::Result<()> {
                match &self.0 {
                    Opened::Local(file) => (&*file).flush(),
                    Opened::Remote(_) => Ok(()),
                }
            }
        }

        impl Seek for $file {
            fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
                match &self.0 {
                    Opened::Local(file) => (&*file).seek(to),
                    Opened::Remote(file) => file.seek(to),
                }
            }
        }
    )+};
}

streams!(File, &File);

impl Default for OpenOptions {
    fn default() -> OpenOptions {
        OpenOptions::new()
    }
}

#[allow(missing_docs, clippy::missing_errors_doc, reason = "as in std::fs")]
impl OpenOptions {
    #[must_use]
    pub fn new() -> OpenOptions {
        let local = system::OpenOptions::new();
        OpenOptions { local, writes: false, appends: false, creates: false, replaces: false }
    }

    pub fn read(&mut self, is_set: bool) -> &mut OpenOptions {
        self.local.read(is_set);
        self
    }

    pub fn write(&mut self, is_set: bool) -> &mut OpenOptions {
        self.writes = is_set;
        self.local.write(is_set);
        self
    }

    pub fn append(&mut self, is_set: bool) -> &mut OpenOptions {
        self.appends = is_set;
        self.local.append(is_set);
        self
    }

    pub fn create(&mut self, is_set: bool) -> &mut OpenOptions {
        self.creates = is_set;
        self.local.create(is_set);
        self
    }

    pub fn create_new(&mut self, is_set: bool) -> &mut OpenOptions {
        self.replaces = is_set;
        self.local.create_new(is_set);
        self
    }

    pub fn truncate(&mut self, is_set: bool) -> &mut OpenOptions {
        self.replaces = is_set;
        self.local.truncate(is_set);
        self
    }

    /// Opens a file. An object can be read, appended to, or opened to be locked (created without being truncated).
    pub fn open(&self, path: impl AsRef<Path>) -> io::Result<File> {
        let path = path.as_ref();
        if !is_remote(path) {
            return Ok(File(Opened::Local(self.local.open(path)?)));
        }
        let file = match (self.appends, self.writes) {
            (true, _) => RemoteFile::append(path)?,
            (false, false) => RemoteFile::open(path)?,
            (false, true) if self.creates && !self.replaces => RemoteFile::lock(path)?,
            (false, true) => return unsupported("an object is written whole"),
        };
        Ok(File(Opened::Remote(Box::new(file))))
    }
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

macro_rules! functions {
    ($($name:ident($path:ident) -> $made:ty: $remote:expr;)+) => {$(
        #[doc = concat!("As `std::fs::", stringify!($name), "`.\n\n# Errors\nAs there.")]
        pub fn $name($path: impl AsRef<Path>) -> io::Result<$made> {
            let $path = $path.as_ref();
            match is_remote($path) {
                true => $remote,
                false => system::$name($path),
            }
        }
    )+};
}

functions! {
    canonicalize(path) -> PathBuf: Ok(PathBuf::from(url(path)?));
    create_dir(path) -> (): match objects::store()?.list(&url(path)?)?.is_empty() {
        true => Ok(()),
        false => Err(io::ErrorKind::AlreadyExists.into()),
    };
    create_dir_all(path) -> (): objects::store().map(drop);
    read(path) -> Vec<u8>: objects::store()?.read(&url(path)?, None, None);
    remove_dir(path) -> (): objects::store().map(drop);
    remove_dir_all(path) -> (): objects::store()?.remove_all(&url(path)?);
    remove_file(path) -> (): objects::store()?.remove(&url(path)?);
}

/// As `std::fs::read_to_string`.
///
/// # Errors
/// As there.
pub fn read_to_string(path: impl AsRef<Path>) -> io::Result<String> {
    String::from_utf8(read(path)?).map_err(|cause| io::Error::new(io::ErrorKind::InvalidData, cause))
}

/// As `std::fs::metadata`.
///
/// # Errors
/// As there.
pub fn metadata(path: impl AsRef<Path>) -> io::Result<Metadata> {
    let path = path.as_ref();
    if !is_remote(path) {
        return Ok(Metadata(About::Local(system::metadata(path)?)));
    }
    let (store, url) = (objects::store()?, url(path)?);
    match store.info(&url) {
        Err(cause) if cause.kind() == io::ErrorKind::NotFound => match store.list(&url) {
            Ok(entries) if !entries.is_empty() => Ok(Metadata(About::Remote(None))),
            _ => Err(cause),
        },
        info => Ok(Metadata(About::Remote(Some(info?)))),
    }
}

/// As `std::fs::symlink_metadata`.
///
/// # Errors
/// As there.
pub fn symlink_metadata(path: impl AsRef<Path>) -> io::Result<Metadata> {
    let path = path.as_ref();
    match is_remote(path) {
        true => metadata(path),
        false => Ok(Metadata(About::Local(system::symlink_metadata(path)?))),
    }
}

/// As `std::fs::read_dir`. A folder of objects that does not exist is empty.
///
/// # Errors
/// As there.
pub fn read_dir(path: impl AsRef<Path>) -> io::Result<ReadDir> {
    let path = path.as_ref();
    Ok(ReadDir(match is_remote(path) {
        true => Listing::Remote(path.to_path_buf(), objects::store()?.list(&url(path)?)?.into_iter()),
        false => Listing::Local(system::read_dir(path)?),
    }))
}

/// As `std::fs::rename`. A file can become an object.
///
/// # Errors
/// As there.
pub fn rename(from: impl AsRef<Path>, to: impl AsRef<Path>) -> io::Result<()> {
    let (from, to) = (from.as_ref(), to.as_ref());
    match (is_remote(from), is_remote(to)) {
        (false, false) => return system::rename(from, to),
        (false, true) => objects::upload(from, to, false)?,
        (true, true) => objects::copy(from, to)?,
        (true, false) => return unsupported("an object cannot be moved into a folder of the system"),
    }
    remove_file(from)
}

/// As `std::fs::hard_link`. To an object, the file is copied; an existing object is not replaced.
///
/// # Errors
/// As there.
pub fn hard_link(from: impl AsRef<Path>, to: impl AsRef<Path>) -> io::Result<()> {
    let (from, to) = (from.as_ref(), to.as_ref());
    match (is_remote(from), is_remote(to)) {
        (false, false) => system::hard_link(from, to),
        (false, true) => objects::upload(from, to, true),
        (true, _) => unsupported("objects have no links"),
    }
}

/// Writes a file that must not exist.
///
/// # Errors
/// [`io::ErrorKind::AlreadyExists`] if it exists, or if it cannot be written.
pub fn write_new(path: impl AsRef<Path>, bytes: impl AsRef<[u8]>) -> io::Result<()> {
    let (path, bytes) = (path.as_ref(), bytes.as_ref());
    match is_remote(path) {
        true => objects::store()?.write(&url(path)?, &mut &bytes[..], bytes.len() as u64, true),
        false => OpenOptions::new().write(true).create_new(true).open(path)?.write_all(bytes),
    }
}

/// As `std::fs::write`.
///
/// # Errors
/// As there.
pub fn write(path: impl AsRef<Path>, bytes: impl AsRef<[u8]>) -> io::Result<()> {
    let (path, bytes) = (path.as_ref(), bytes.as_ref());
    match is_remote(path) {
        true => objects::store()?.write(&url(path)?, &mut &bytes[..], bytes.len() as u64, false),
        false => system::write(path, bytes),
    }
}
