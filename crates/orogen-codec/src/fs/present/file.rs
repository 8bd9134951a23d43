//! Open files, and options for opening them.

use std::fs::{self as system, TryLockError};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;
use std::time::SystemTime;

use super::super::objects::{RemoteFile, is_remote};
use super::metadata::{About, Metadata, Permissions};
use super::unsupported;

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
