//! The items of `std::fs` that Orogen uses, for a host without a file system that keeps files in memory: a browser.
//!
//! There is one tree of files for the process, and it starts with an empty root. Relative paths start at the root.
//! There are no links and no permissions. A program that wants to keep files, or to pass them on, asks which paths have
//! [changed](changes).

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::io::{self, Write};
use std::path::{Component, Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};
use std::time::{Duration, SystemTime};

mod open;

pub use open::{File, OpenOptions};
pub use std::fs::TryLockError;

/// The content of a file, shared by all who have it open. It lives on without a name until it is closed.
#[derive(Debug, Default)]
struct Node {
    bytes: Mutex<Vec<u8>>,
    /// The time of the last change.
    changed: Mutex<Duration>,
    /// The number of the last change, see [`changes`].
    number: AtomicU64,
    is_locked: AtomicBool,
}

/// What a path leads to; `None` for a folder.
type Entry = Option<Arc<Node>>;

#[derive(Debug, Default)]
struct Tree {
    /// All paths but the root, absolute.
    entries: BTreeMap<PathBuf, Entry>,
    /// When paths were last made, renamed or removed, by the number of the change.
    named: BTreeMap<PathBuf, u64>,
}

static TREE: OnceLock<Mutex<Tree>> = OnceLock::new();
static CLOCK: OnceLock<fn() -> Duration> = OnceLock::new();
static NUMBER: AtomicU64 = AtomicU64::new(0);

/// The time since 1970 by this function becomes the time of changed files. Without a clock, each change is a second
/// after the previous one.
pub fn set_clock(clock: fn() -> Duration) {
    let _ = CLOCK.set(clock);
}

/// The paths that were written, made, renamed or removed since the change with the number `since` (0 for all of them),
/// and the number of the last change. Folders are left out.
#[must_use]
pub fn changes(since: u64) -> (u64, Vec<PathBuf>) {
    let tree = tree();
    let mut paths: Vec<PathBuf> = Vec::new();
    for (path, named) in &tree.named {
        let node = tree.entries.get(path);
        let written = node.and_then(Option::as_ref).map_or(0, |node| node.number.load(Ordering::Relaxed));
        if *named.max(&written) > since && !matches!(node, Some(None)) {
            paths.push(path.clone());
        }
    }
    (NUMBER.load(Ordering::Relaxed), paths)
}

fn tree() -> MutexGuard<'static, Tree> {
    lock(TREE.get_or_init(Mutex::default))
}

/// Locks a value that no panic leaves half changed.
fn lock<T>(value: &Mutex<T>) -> MutexGuard<'_, T> {
    value.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The number of a new change.
fn next() -> u64 {
    NUMBER.fetch_add(1, Ordering::Relaxed) + 1
}

/// The absolute path without `.` and `..`.
fn absolute(path: &Path) -> PathBuf {
    let mut real = PathBuf::from("/");
    for part in path.components() {
        match part {
            Component::Normal(name) => real.push(name),
            Component::ParentDir => drop(real.pop()),
            Component::CurDir | Component::RootDir | Component::Prefix(_) => {}
        }
    }
    real
}

impl Node {
    /// Records a change of the content.
    fn touch(&self) {
        let number = next();
        self.number.store(number, Ordering::Relaxed);
        *lock(&self.changed) = CLOCK.get().map_or(Duration::from_secs(number), |clock| clock());
    }
}

impl Tree {
    fn is_folder(&self, path: &Path) -> bool {
        path == Path::new("/") || matches!(self.entries.get(path), Some(None))
    }

    fn node(&self, path: &Path) -> io::Result<Arc<Node>> {
        match self.entries.get(path) {
            Some(Some(node)) => Ok(Arc::clone(node)),
            _ if self.is_folder(path) => Err(io::ErrorKind::IsADirectory.into()),
            _ => Err(io::ErrorKind::NotFound.into()),
        }
    }

    /// Names a file or a folder. Its folder must exist.
    fn put(&mut self, path: &Path, entry: Entry) -> io::Result<()> {
        let folder = path.parent().ok_or(io::ErrorKind::AlreadyExists)?;
        if !self.is_folder(folder) {
            return Err(io::ErrorKind::NotFound.into());
        }
        self.entries.insert(path.to_path_buf(), entry);
        self.named.insert(path.to_path_buf(), next());
        Ok(())
    }

    fn take(&mut self, path: &Path) -> Option<Entry> {
        let entry = self.entries.remove(path)?;
        self.named.insert(path.to_path_buf(), next());
        Some(entry)
    }

    /// The paths below a folder.
    fn below(&self, folder: &Path) -> Vec<PathBuf> {
        let after = self.entries.range::<Path, _>((std::ops::Bound::Excluded(folder), std::ops::Bound::Unbounded));
        after.map(|(path, _)| path).take_while(|path| path.starts_with(folder)).cloned().collect()
    }
}

/// Metadata of a file or a folder.
#[derive(Debug, Clone)]
pub struct Metadata {
    /// Length in bytes; `None` for a folder.
    length: Option<u64>,
    changed: Duration,
}

/// Permissions of a file: everything is allowed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Permissions;

/// The type of an entry: file or folder.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct FileType {
    is_dir: bool,
}

/// A file or folder inside a folder.
#[derive(Debug)]
pub struct DirEntry {
    path: PathBuf,
    metadata: Metadata,
}

/// An iterator over the files and folders inside a folder.
#[derive(Debug)]
pub struct ReadDir(std::vec::IntoIter<DirEntry>);

impl Metadata {
    fn of(entry: &Entry) -> Metadata {
        match entry {
            Some(node) => Metadata { length: Some(lock(&node.bytes).len() as u64), changed: *lock(&node.changed) },
            None => Metadata { length: None, changed: Duration::ZERO },
        }
    }
}

#[allow(missing_docs, clippy::missing_errors_doc, clippy::len_without_is_empty, reason = "as in std::fs")]
impl Metadata {
    #[must_use]
    pub fn is_file(&self) -> bool {
        self.length.is_some()
    }

    #[must_use]
    pub fn is_dir(&self) -> bool {
        self.length.is_none()
    }

    #[must_use]
    pub fn is_symlink(&self) -> bool {
        false
    }

    #[must_use]
    pub fn len(&self) -> u64 {
        self.length.unwrap_or(0)
    }

    #[must_use]
    pub fn permissions(&self) -> Permissions {
        Permissions
    }

    pub fn modified(&self) -> io::Result<SystemTime> {
        Ok(SystemTime::UNIX_EPOCH + self.changed)
    }
}

#[allow(missing_docs, reason = "as in std::fs")]
impl Permissions {
    #[must_use]
    pub fn readonly(&self) -> bool {
        false
    }
}

#[allow(missing_docs, reason = "as in std::fs")]
impl FileType {
    #[must_use]
    pub fn is_file(&self) -> bool {
        !self.is_dir
    }

    #[must_use]
    pub fn is_dir(&self) -> bool {
        self.is_dir
    }
}

#[allow(missing_docs, clippy::missing_errors_doc, reason = "as in std::fs")]
impl DirEntry {
    #[must_use]
    pub fn path(&self) -> PathBuf {
        self.path.clone()
    }

    #[must_use]
    pub fn file_name(&self) -> OsString {
        self.path.file_name().unwrap_or_default().to_owned()
    }

    pub fn file_type(&self) -> io::Result<FileType> {
        Ok(FileType { is_dir: self.metadata.is_dir() })
    }

    pub fn metadata(&self) -> io::Result<Metadata> {
        Ok(self.metadata.clone())
    }
}

impl Iterator for ReadDir {
    type Item = io::Result<DirEntry>;

    fn next(&mut self) -> Option<io::Result<DirEntry>> {
        self.0.next().map(Ok)
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
    ($($name:ident($path:ident) -> $made:ty: $body:expr;)+) => {$(
        #[doc = concat!("As `std::fs::", stringify!($name), "`.\n\n# Errors\nAs there.")]
        pub fn $name($path: impl AsRef<Path>) -> io::Result<$made> {
            let $path = absolute($path.as_ref());
            $body
        }
    )+};
}

functions! {
    canonicalize(path) -> PathBuf: {
        let is_there = path == Path::new("/") || tree().entries.contains_key(&path);
        if is_there { Ok(path) } else { Err(io::ErrorKind::NotFound.into()) }
    };
    create_dir(path) -> (): {
        let mut tree = tree();
        match tree.entries.contains_key(&path) || tree.is_folder(&path) {
            true => Err(io::ErrorKind::AlreadyExists.into()),
            false => tree.put(&path, None),
        }
    };
    create_dir_all(path) -> (): {
        let mut tree = tree();
        let mut folders: Vec<&Path> = path.ancestors().filter(|folder| !tree.is_folder(folder)).collect();
        folders.reverse();
        folders.into_iter().try_for_each(|folder| match tree.entries.contains_key(folder) {
            true => Err(io::ErrorKind::NotADirectory.into()),
            false => tree.put(folder, None),
        })
    };
    metadata(path) -> Metadata: match tree().entries.get(&path) {
        Some(entry) => Ok(Metadata::of(entry)),
        None if path == Path::new("/") => Ok(Metadata::of(&None)),
        None => Err(io::ErrorKind::NotFound.into()),
    };
    symlink_metadata(path) -> Metadata: metadata(path);
    read(path) -> Vec<u8>: {
        let node = tree().node(&path)?;
        let bytes = lock(&node.bytes).clone();
        Ok(bytes)
    };
    read_to_string(path) -> String:
        String::from_utf8(read(path)?).map_err(|cause| io::Error::new(io::ErrorKind::InvalidData, cause));
    read_dir(path) -> ReadDir: {
        let tree = tree();
        if !tree.is_folder(&path) {
            return Err(io::ErrorKind::NotFound.into());
        }
        let inside = tree.below(&path).into_iter().filter(|below| below.parent() == Some(&path));
        let entry = |below: PathBuf| Some(DirEntry { metadata: Metadata::of(tree.entries.get(&below)?), path: below });
        Ok(ReadDir(inside.filter_map(entry).collect::<Vec<_>>().into_iter()))
    };
    remove_dir(path) -> (): {
        let mut tree = tree();
        match (tree.is_folder(&path), tree.below(&path).is_empty()) {
            (false, _) => Err(io::ErrorKind::NotFound.into()),
            (true, false) => Err(io::ErrorKind::DirectoryNotEmpty.into()),
            (true, true) => { tree.take(&path); Ok(()) }
        }
    };
    remove_dir_all(path) -> (): {
        let mut tree = tree();
        if !tree.is_folder(&path) {
            return Err(io::ErrorKind::NotFound.into());
        }
        for below in tree.below(&path) {
            tree.take(&below);
        }
        tree.take(&path);
        Ok(())
    };
    remove_file(path) -> (): {
        let mut tree = tree();
        tree.node(&path)?;
        tree.take(&path);
        Ok(())
    };
}

/// As `std::fs::rename`, for files.
///
/// # Errors
/// As there.
pub fn rename(from: impl AsRef<Path>, to: impl AsRef<Path>) -> io::Result<()> {
    let (from, to) = (absolute(from.as_ref()), absolute(to.as_ref()));
    let mut tree = tree();
    let node = tree.node(&from)?;
    if tree.is_folder(&to) {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    tree.put(&to, Some(node))?;
    if from != to {
        tree.take(&from);
    }
    Ok(())
}

/// As `std::fs::hard_link`.
///
/// # Errors
/// As there.
pub fn hard_link(from: impl AsRef<Path>, to: impl AsRef<Path>) -> io::Result<()> {
    let (from, to) = (absolute(from.as_ref()), absolute(to.as_ref()));
    let mut tree = tree();
    let node = tree.node(&from)?;
    match tree.entries.contains_key(&to) || tree.is_folder(&to) {
        true => Err(io::ErrorKind::AlreadyExists.into()),
        false => tree.put(&to, Some(node)),
    }
}

/// Writes a file that must not exist.
///
/// # Errors
/// [`io::ErrorKind::AlreadyExists`] if it exists, or if it cannot be written.
pub fn write_new(path: impl AsRef<Path>, bytes: impl AsRef<[u8]>) -> io::Result<()> {
    OpenOptions::new().write(true).create_new(true).open(path)?.write_all(bytes.as_ref())
}

/// As `std::fs::write`.
///
/// # Errors
/// As there.
pub fn write(path: impl AsRef<Path>, bytes: impl AsRef<[u8]>) -> io::Result<()> {
    File::create(path)?.write_all(bytes.as_ref())
}

#[cfg(test)]
mod tests;
