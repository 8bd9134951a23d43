//! Open files in memory, and options for opening them.

use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::SystemTime;

use super::{Metadata, Node, Permissions, TryLockError, absolute, lock, tree};

/// An open file.
#[derive(Debug)]
pub struct File {
    node: Arc<Node>,
    position: Mutex<u64>,
    appends: bool,
    /// Whether this file has the lock.
    has_lock: AtomicBool,
}

/// Options for opening a file.
#[derive(Debug, Clone, Default)]
pub struct OpenOptions {
    writes: bool,
    appends: bool,
    truncates: bool,
    creates: bool,
    creates_new: bool,
}

#[allow(missing_docs, clippy::missing_errors_doc, reason = "as in std::fs")]
impl File {
    pub fn open(path: impl AsRef<Path>) -> io::Result<File> {
        OpenOptions::new().read(true).open(path)
    }

    pub fn create(path: impl AsRef<Path>) -> io::Result<File> {
        OpenOptions::new().write(true).create(true).truncate(true).open(path)
    }

    #[must_use]
    pub fn options() -> OpenOptions {
        OpenOptions::new()
    }

    pub fn metadata(&self) -> io::Result<Metadata> {
        Ok(Metadata::of(&Some(Arc::clone(&self.node))))
    }

    pub fn set_permissions(&self, _: Permissions) -> io::Result<()> {
        Ok(())
    }

    pub fn set_modified(&self, time: SystemTime) -> io::Result<()> {
        *lock(&self.node.changed) = time.duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default();
        Ok(())
    }

    pub fn set_len(&self, length: u64) -> io::Result<()> {
        let length = usize::try_from(length).map_err(|_| io::ErrorKind::StorageFull)?;
        self.resize(&mut lock(&self.node.bytes), length)?;
        self.node.touch();
        Ok(())
    }

    pub fn sync_all(&self) -> io::Result<()> {
        Ok(())
    }

    pub fn sync_data(&self) -> io::Result<()> {
        Ok(())
    }

    pub fn try_lock(&self) -> Result<(), TryLockError> {
        match self.node.is_locked.swap(true, Ordering::Relaxed) {
            true => Err(TryLockError::WouldBlock),
            false => {
                self.has_lock.store(true, Ordering::Relaxed);
                Ok(())
            }
        }
    }

    pub fn try_lock_shared(&self) -> Result<(), TryLockError> {
        self.try_lock()
    }

    /// Changes the length; new bytes are zero.
    fn resize(&self, bytes: &mut Vec<u8>, length: usize) -> io::Result<()> {
        bytes.try_reserve(length.saturating_sub(bytes.len())).map_err(|_| io::ErrorKind::StorageFull)?;
        bytes.resize(length, 0);
        Ok(())
    }

    fn read_part(&self, out: &mut [u8]) -> usize {
        let (bytes, mut position) = (lock(&self.node.bytes), lock(&self.position));
        let rest = usize::try_from(*position).ok().and_then(|at| bytes.get(at..)).unwrap_or_default();
        let count = rest.len().min(out.len());
        out[..count].copy_from_slice(&rest[..count]);
        *position += count as u64;
        count
    }

    fn write_part(&self, part: &[u8]) -> io::Result<usize> {
        let (mut bytes, mut position) = (lock(&self.node.bytes), lock(&self.position));
        let at = if self.appends { bytes.len() } else { *position as usize };
        let end = at.checked_add(part.len()).ok_or(io::ErrorKind::StorageFull)?;
        if end > bytes.len() {
            self.resize(&mut bytes, end)?;
        }
        bytes[at..end].copy_from_slice(part);
        *position = end as u64;
        self.node.touch();
        Ok(part.len())
    }

    fn seek_to(&self, to: SeekFrom) -> io::Result<u64> {
        let length = lock(&self.node.bytes).len() as u64;
        let mut position = lock(&self.position);
        let at = match to {
            SeekFrom::Start(at) => Some(at),
            SeekFrom::End(by) => length.checked_add_signed(by),
            SeekFrom::Current(by) => position.checked_add_signed(by),
        };
        *position = at.filter(|at| usize::try_from(*at).is_ok()).ok_or(io::ErrorKind::InvalidInput)?;
        Ok(*position)
    }
}

impl Drop for File {
    fn drop(&mut self) {
        if self.has_lock.load(Ordering::Relaxed) {
            self.node.is_locked.store(false, Ordering::Relaxed);
        }
    }
}

macro_rules! streams {
    ($($file:ty),+) => {$(
        impl Read for $file {
            fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
                Ok(self.read_part(bytes))
            }
        }

        impl Write for $file {
            fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
                self.write_part(bytes)
            }

            fn flush(&mut self) -> io::Result<()> {
                Ok(())
            }
        }

        impl Seek for $file {
            fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
                self.seek_to(to)
            }
        }
    )+};
}

streams!(File, &File);

#[allow(missing_docs, clippy::missing_errors_doc, reason = "as in std::fs")]
impl OpenOptions {
    #[must_use]
    pub fn new() -> OpenOptions {
        OpenOptions::default()
    }

    pub fn read(&mut self, _: bool) -> &mut OpenOptions {
        self
    }

    pub fn write(&mut self, is_set: bool) -> &mut OpenOptions {
        self.writes = is_set;
        self
    }

    pub fn append(&mut self, is_set: bool) -> &mut OpenOptions {
        self.appends = is_set;
        self
    }

    pub fn create(&mut self, is_set: bool) -> &mut OpenOptions {
        self.creates = is_set;
        self
    }

    pub fn create_new(&mut self, is_set: bool) -> &mut OpenOptions {
        self.creates_new = is_set;
        self
    }

    pub fn truncate(&mut self, is_set: bool) -> &mut OpenOptions {
        self.truncates = is_set;
        self
    }

    pub fn open(&self, path: impl AsRef<Path>) -> io::Result<File> {
        let path = absolute(path.as_ref());
        let may_write = self.writes || self.appends;
        let mut tree = tree();
        let node = match tree.node(&path) {
            Ok(_) if may_write && self.creates_new => return Err(io::ErrorKind::AlreadyExists.into()),
            Err(cause)
                if cause.kind() == io::ErrorKind::NotFound && may_write && (self.creates || self.creates_new) =>
            {
                let node = Arc::new(Node::default());
                node.touch();
                tree.put(&path, Some(Arc::clone(&node)))?;
                node
            }
            found => found?,
        };
        if self.truncates && self.writes {
            lock(&node.bytes).clear();
            node.touch();
        }
        Ok(File { node, position: Mutex::new(0), appends: self.appends, has_lock: AtomicBool::new(false) })
    }
}
