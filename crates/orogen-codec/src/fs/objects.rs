//! Objects of a store such as S3, behind paths that are URLs.
//!
//! A program [mounts](mount) a store. From then on, the functions of [`fs`](super) read and write its objects wherever
//! a path starts with a scheme such as `s3://`. An object is like a file, with these differences:
//!
//! - It is written whole, and visible only when it is complete. A temporary file for it is a file of the system.
//! - Folders are the parts of names before slashes. They exist as long as there is an object in them.
//! - There are no links, permissions and locks.
//! - What is appended to an object is sent from time to time, at the latest when the file is dropped.

use std::fmt::Debug;
use std::io::{self, Read, SeekFrom};
use std::ops::Range;
use std::path::Path;
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};
use std::time::SystemTime;

/// The start of paths that name objects.
const SCHEMES: [&str; 7] = ["s3://", "gs://", "az://", "abfs://", "abfss://", "http://", "https://"];

/// Whether a path names an object, or a folder of objects.
#[must_use]
pub fn is_remote(path: impl AsRef<Path>) -> bool {
    path.as_ref().to_str().is_some_and(|text| SCHEMES.iter().any(|scheme| text.starts_with(scheme)))
}

/// Whether a path names something that can be read, but not written: a file on an HTTP server.
#[must_use]
pub fn is_read_only(path: &Path) -> bool {
    path.to_str().is_some_and(|text| text.starts_with("http://") || text.starts_with("https://"))
}

/// What is known about an object without its content.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ObjectInfo {
    /// Length in bytes.
    pub length: u64,
    /// Time of the last change.
    pub changed: SystemTime,
    /// A tag that changes with the content, if the store has tags.
    pub tag: Option<String>,
}

/// An object or a folder in a folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ObjectEntry {
    /// The name within the folder.
    pub name: String,
    /// `None` for a folder.
    pub object: Option<ObjectInfo>,
}

/// A store of objects by URL. Implementations repeat failed requests themselves.
pub trait ObjectStore: Send + Sync + Debug {
    /// Looks an object up.
    ///
    /// # Errors
    /// [`io::ErrorKind::NotFound`] if there is none, or if the store cannot be reached.
    fn info(&self, url: &str) -> io::Result<ObjectInfo>;

    /// Reads a range of an object, or all of it. If `tag` is given, the object must still have that tag.
    ///
    /// # Errors
    /// If there is no such object or range, or the store cannot be reached.
    fn read(&self, url: &str, range: Option<Range<u64>>, tag: Option<&str>) -> io::Result<Vec<u8>>;

    /// The objects and folders in a folder; none if it does not exist.
    ///
    /// # Errors
    /// If the store cannot be reached, or does not list objects.
    fn list(&self, url: &str) -> io::Result<Vec<ObjectEntry>>;

    /// Writes an object with the next `length` bytes of `content`. With `only_new`, an existing object is not replaced.
    ///
    /// # Errors
    /// [`io::ErrorKind::AlreadyExists`] if it exists and `only_new` is set, or if it cannot be written.
    fn write(&self, url: &str, content: &mut dyn Read, length: u64, only_new: bool) -> io::Result<()>;

    /// Removes an object.
    ///
    /// # Errors
    /// If it cannot be removed. Some stores do not report that there was none.
    fn remove(&self, url: &str) -> io::Result<()>;

    /// Removes all objects in a folder and in the folders in it.
    ///
    /// # Errors
    /// If one cannot be removed.
    fn remove_all(&self, url: &str) -> io::Result<()>;
}

static MOUNTED: OnceLock<Box<dyn ObjectStore>> = OnceLock::new();

/// Uses a store for all paths that are URLs, in the whole process. If there already is one, it stays.
pub fn mount(store: Box<dyn ObjectStore>) {
    let _ = MOUNTED.set(store);
}

/// The mounted store.
pub(super) fn store() -> io::Result<&'static dyn ObjectStore> {
    MOUNTED.get().map(|store| &**store).ok_or_else(|| {
        let message = "this build reads and writes no object stores; build it with the feature `remote`";
        io::Error::new(io::ErrorKind::Unsupported, message)
    })
}

/// The URL of an object, without a slash at the end.
pub(super) fn url(path: &Path) -> io::Result<String> {
    let text = path.to_str().ok_or(io::ErrorKind::InvalidInput)?;
    // Paths are joined with the separator of the system.
    let text = if cfg!(windows) { text.replace('\\', "/") } else { text.to_string() };
    Ok(text.trim_end_matches('/').to_string())
}

/// Length of the first request for a part of an object, and of the longest one, in bytes. Like GDAL, each request
/// that continues the one before is twice as long.
const SHORTEST: u64 = 64 << 10;
const LONGEST: u64 = 4 << 20;

/// An object that is open for reading, appending or locking.
#[derive(Debug)]
pub(super) struct RemoteFile {
    url: String,
    info: ObjectInfo,
    state: Mutex<State>,
}

#[derive(Debug)]
enum State {
    Read(Window),
    Append(Appended),
    /// A file that exists to be locked; no object is made of it.
    Lock,
}

/// The bytes that were read last, and the position of the reader.
#[derive(Debug, Default)]
struct Window {
    position: u64,
    start: u64,
    bytes: Vec<u8>,
    /// Length of the next request.
    ahead: u64,
}

/// The content of an object that is appended to.
#[derive(Debug, Default)]
struct Appended {
    bytes: Vec<u8>,
    /// Number of bytes that the object has.
    sent: usize,
}

impl RemoteFile {
    pub fn open(path: &Path) -> io::Result<RemoteFile> {
        let url = url(path)?;
        let info = store()?.info(&url)?;
        Ok(RemoteFile { url, info, state: Mutex::new(State::Read(Window { ahead: SHORTEST, ..Window::default() })) })
    }

    pub fn append(path: &Path) -> io::Result<RemoteFile> {
        let url = url(path)?;
        let bytes = store()?.read(&url, None, None)?;
        let info = ObjectInfo { length: bytes.len() as u64, changed: SystemTime::now(), tag: None };
        let sent = bytes.len();
        Ok(RemoteFile { url, info, state: Mutex::new(State::Append(Appended { bytes, sent })) })
    }

    pub fn lock(path: &Path) -> io::Result<RemoteFile> {
        store()?;
        let info = ObjectInfo { length: 0, changed: SystemTime::now(), tag: None };
        Ok(RemoteFile { url: url(path)?, info, state: Mutex::new(State::Lock) })
    }

    pub fn info(&self) -> &ObjectInfo {
        &self.info
    }

    /// Sends what was appended.
    pub fn sync(&self) -> io::Result<()> {
        match &mut *self.state() {
            State::Append(appended) => appended.send(&self.url),
            State::Read(_) | State::Lock => Ok(()),
        }
    }

    pub fn read_exact_at(&self, at: u64, bytes: &mut [u8]) -> io::Result<()> {
        let end = at.checked_add(bytes.len() as u64).filter(|end| *end <= self.info.length);
        let end = end.ok_or(io::ErrorKind::UnexpectedEof)?;
        if bytes.is_empty() {
            return Ok(());
        }
        if bytes.len() as u64 >= SHORTEST {
            bytes.copy_from_slice(&self.request(at..end)?);
            return Ok(());
        }
        let mut state = self.state();
        let State::Read(window) = &mut *state else { return Err(io::ErrorKind::Unsupported.into()) };
        let mut done = 0;
        while done < bytes.len() {
            let there = self.available(window, at + done as u64, bytes.len() - done)?;
            let count = there.len().min(bytes.len() - done);
            bytes[done..done + count].copy_from_slice(&there[..count]);
            done += count;
        }
        Ok(())
    }

    /// The bytes from offset `at` on that are in memory, after a request if there are none.
    fn available<'w>(&self, window: &'w mut Window, at: u64, needed: usize) -> io::Result<&'w [u8]> {
        let read_until = window.start + window.bytes.len() as u64;
        if !(window.start..read_until).contains(&at) {
            let continues = at == read_until && !window.bytes.is_empty();
            window.ahead = if continues { (2 * window.ahead).min(LONGEST) } else { SHORTEST };
            let left = self.info.length.saturating_sub(at);
            window.bytes = self.request(at..at + left.min(window.ahead.max(needed as u64)))?;
            window.start = at;
        }
        Ok(&window.bytes[(at - window.start) as usize..])
    }

    /// Reads a range, of which nothing may be missing.
    fn request(&self, range: Range<u64>) -> io::Result<Vec<u8>> {
        let length = range.end - range.start;
        let bytes = store()?.read(&self.url, Some(range), self.info.tag.as_deref())?;
        match bytes.len() as u64 == length {
            true => Ok(bytes),
            false => Err(io::Error::new(io::ErrorKind::UnexpectedEof, "the server sent another part than asked for")),
        }
    }

    pub fn read(&self, out: &mut [u8]) -> io::Result<usize> {
        let mut state = self.state();
        let State::Read(window) = &mut *state else { return Err(io::ErrorKind::Unsupported.into()) };
        let left = self.info.length.saturating_sub(window.position);
        let count = left.min(out.len() as u64) as usize;
        if count == 0 {
            return Ok(0);
        }
        let there = self.available(window, window.position, count)?;
        let count = count.min(there.len());
        out[..count].copy_from_slice(&there[..count]);
        window.position += count as u64;
        Ok(count)
    }

    pub fn seek(&self, to: SeekFrom) -> io::Result<u64> {
        let mut state = self.state();
        let State::Read(window) = &mut *state else { return Err(io::ErrorKind::Unsupported.into()) };
        let position = match to {
            SeekFrom::Start(at) => Some(at),
            SeekFrom::End(by) => self.info.length.checked_add_signed(by),
            SeekFrom::Current(by) => window.position.checked_add_signed(by),
        };
        window.position = position.ok_or(io::ErrorKind::InvalidInput)?;
        Ok(window.position)
    }

    pub fn write(&self, bytes: &[u8]) -> io::Result<usize> {
        match &mut *self.state() {
            State::Append(appended) => {
                appended.bytes.extend_from_slice(bytes);
                // In proportion, so that all requests together send a few times the whole content.
                let is_much = appended.bytes.len() - appended.sent > (appended.sent / 8).max(SHORTEST as usize / 16);
                if is_much {
                    appended.send(&self.url)?;
                }
                Ok(bytes.len())
            }
            State::Read(_) | State::Lock => {
                Err(io::Error::new(io::ErrorKind::Unsupported, "an object is written whole"))
            }
        }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for RemoteFile {
    fn drop(&mut self) {
        // What was not sent is missing after an interruption, too.
        let _ = self.sync();
    }
}

impl Appended {
    fn send(&mut self, url: &str) -> io::Result<()> {
        if self.sent < self.bytes.len() {
            store()?.write(url, &mut &self.bytes[..], self.bytes.len() as u64, false)?;
            self.sent = self.bytes.len();
        }
        Ok(())
    }
}

/// Copies a file of the system into an object.
pub(super) fn upload(from: &Path, to: &Path, only_new: bool) -> io::Result<()> {
    let mut file = std::fs::File::open(from)?;
    let length = file.metadata()?.len();
    store()?.write(&url(to)?, &mut file, length, only_new)
}

/// Copies an object into another one. For small objects: it passes through memory.
pub(super) fn copy(from: &Path, to: &Path) -> io::Result<()> {
    let bytes = store()?.read(&url(from)?, None, None)?;
    store()?.write(&url(to)?, &mut &bytes[..], bytes.len() as u64, false)
}
