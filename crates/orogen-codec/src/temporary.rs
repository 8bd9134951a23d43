//! Temporary files, which are also removed after their process was killed.
//!
//! A process that writes into a folder holds a lock there: it locks a file `.orogen-PID-N.lock` as long as it has
//! temporary files `.orogen-PID-N-K.tmp` next to it. The system releases the lock when the process ends, for any
//! reason. A temporary file whose lock is free or does not exist therefore has no owner. Process numbers are not
//! sufficient, because they are reused, and because containers that share a folder have separate numbers.

use std::collections::HashMap;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError, Weak};

use crate::fs::{self, File, OpenOptions, TryLockError};

/// Number of names to try. If all of them are taken, something is wrong with the folder.
const NAMES: usize = 100;

const PREFIX: &str = ".orogen-";
const LOCK: &str = ".lock";
const TEMPORARY: &str = ".tmp";

/// A temporary file in the folder of its target. It is removed on drop unless it was renamed.
#[derive(Debug)]
pub struct Temporary {
    path: PathBuf,
    /// Shows that this process is alive. Dropped after the file is removed.
    _lock: Option<Arc<FolderLock>>,
}

impl Temporary {
    /// Creates a temporary file in `folder`. Its name does not contain the target's name, so that the longest file
    /// names work. The file must not exist, so that a file or link planted under its name is neither followed nor
    /// overwritten.
    pub fn create(folder: &Path) -> io::Result<(Temporary, File)> {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        // What becomes an object is a file of the system until then.
        let folder = &if fs::is_remote(folder) { fs::temporary_folder() } else { folder.to_path_buf() };
        let lock = FolderLock::hold(folder)?;
        for _ in 0..NAMES {
            let count = COUNT.fetch_add(1, Ordering::Relaxed);
            let path = folder.join(format!("{}-{count}{TEMPORARY}", lock.stem));
            match OpenOptions::new().read(true).write(true).create_new(true).open(&path) {
                Ok(file) => return Ok((Temporary { path, _lock: Some(lock) }, file)),
                Err(cause) if cause.kind() == io::ErrorKind::AlreadyExists => {}
                Err(cause) => return Err(cause),
            }
        }
        Err(io::Error::other("too many temporary files are left in its folder"))
    }

    /// The temporary path.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Removes the name of the file, which continues to exist while it is open. Returns the temporary file if the
    /// system does not support that.
    #[must_use]
    pub fn unlink(mut self) -> Option<Temporary> {
        match fs::remove_file(&self.path) {
            Ok(()) => {
                self.path = PathBuf::new();
                None
            }
            Err(_) => Some(self),
        }
    }

    /// Moves the file to its target, replacing an existing one.
    pub fn rename(mut self, real: &Path) -> io::Result<()> {
        fs::rename(&self.path, real)?;
        self.path = PathBuf::new();
        Ok(())
    }

    /// Moves the file to its target atomically, if the target does not exist.
    pub fn rename_new(self, real: &Path) -> io::Result<()> {
        match fs::hard_link(&self.path, real) {
            // Dropping `self` removes the temporary name.
            Ok(()) => Ok(()),
            Err(cause) if cause.kind() == io::ErrorKind::AlreadyExists => Err(cause),
            Err(cause) if fs::is_remote(real) => Err(cause),
            // On a file system without hard links, only this check is possible.
            Err(_) if !fs::is_taken(real) => self.rename(real),
            Err(_) => Err(io::ErrorKind::AlreadyExists.into()),
        }
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        if !self.path.as_os_str().is_empty() {
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// This process's lock in a folder, held while it has temporary files there.
#[derive(Debug)]
struct FolderLock {
    /// The prefix of its temporary files' names.
    stem: String,
    path: PathBuf,
    _file: File,
}

impl FolderLock {
    /// The lock that this process already has in `folder`, or a new one. Taking the first lock in a folder removes
    /// files that killed processes left there.
    fn hold(folder: &Path) -> io::Result<Arc<FolderLock>> {
        static HELD: OnceLock<Mutex<HashMap<PathBuf, Weak<FolderLock>>>> = OnceLock::new();
        let real = fs::canonicalize(folder)?;
        let mut held = HELD.get_or_init(Mutex::default).lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(lock) = held.get(&real).and_then(Weak::upgrade) {
            return Ok(lock);
        }
        if !held.contains_key(&real) {
            sweep(&real);
        }
        let lock = Arc::new(FolderLock::create(&real)?);
        held.insert(real, Arc::downgrade(&lock));
        Ok(lock)
    }

    fn create(folder: &Path) -> io::Result<FolderLock> {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        for _ in 0..NAMES {
            let count = COUNT.fetch_add(1, Ordering::Relaxed);
            let stem = format!("{PREFIX}{}-{count}", fs::process());
            let path = folder.join(format!("{stem}{LOCK}"));
            let file = match OpenOptions::new().write(true).create_new(true).open(&path) {
                Ok(file) => file,
                Err(cause) if cause.kind() == io::ErrorKind::AlreadyExists => continue,
                Err(cause) => return Err(cause),
            };
            match file.try_lock() {
                // Another process has cleaned the folder between creation and locking, and removes the file.
                Err(TryLockError::WouldBlock) => continue,
                Ok(()) if !fs::is_present(&path) => continue,
                // On a file system without locks, leftover temporary files are never removed.
                Ok(()) | Err(TryLockError::Error(_)) => return Ok(FolderLock { stem, path, _file: file }),
            }
        }
        Err(io::Error::other("too many temporary files are left in its folder"))
    }
}

impl Drop for FolderLock {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.path);
    }
}

/// Removes temporary files in `folder` whose process has ended. Files that cannot be removed stay.
pub fn sweep(folder: &Path) {
    if fs::is_remote(folder) {
        return;
    }
    let Ok(entries) = fs::read_dir(folder) else { return };
    let mut left: HashMap<String, Vec<PathBuf>> = HashMap::new();
    for entry in entries.flatten() {
        let name = entry.file_name().to_string_lossy().into_owned();
        // Links are not followed, and pipes are not opened.
        if let Some(stem) = stem(&name)
            && entry.file_type().is_ok_and(|kind| kind.is_file())
        {
            left.entry(stem).or_default().push(entry.path());
        }
    }
    for (stem, files) in left {
        let path = folder.join(format!("{stem}{LOCK}"));
        let lock = match OpenOptions::new().write(true).open(&path) {
            Ok(lock) => lock.try_lock().is_ok().then_some(Some(lock)),
            // The lock is created before the files, and removed after them.
            Err(cause) if cause.kind() == io::ErrorKind::NotFound => Some(None),
            Err(_) => None,
        };
        if let Some(_held) = lock {
            // The lock is removed last. Remaining files without a lock still have no owner.
            files.iter().filter(|file| **file != path).for_each(|file| drop(fs::remove_file(file)));
            let _ = fs::remove_file(&path);
        }
    }
}

/// The prefix (process and count) of a file name made by this module.
fn stem(name: &str) -> Option<String> {
    let numbers = |text: &str, count: usize| {
        let parts: Vec<&str> = text.split('-').collect();
        let digits =
            |part: &&str| !part.is_empty() && part.len() <= 20 && part.bytes().all(|byte| byte.is_ascii_digit());
        (parts.len() == count && parts.iter().all(digits)).then(|| format!("{PREFIX}{}-{}", parts[0], parts[1]))
    };
    let rest = name.strip_prefix(PREFIX)?;
    match rest.strip_suffix(LOCK) {
        Some(rest) => numbers(rest, 2),
        None => numbers(rest.strip_suffix(TEMPORARY)?, 3),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder(name: &str) -> PathBuf {
        let path = std::env::temp_dir().join(format!("orogen-temporary-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        path
    }

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> =
            fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn what_is_left_behind_goes_and_nothing_else() {
        let folder = folder("sweep");
        for name in [
            // Files of a killed process, with and without its lock file.
            ".orogen-7-0.lock",
            ".orogen-7-0-0.tmp",
            ".orogen-7-0-12.tmp",
            ".orogen-9-3-1.tmp",
            // Files with other names.
            ".orogen-7-0-0.tmp.bak",
            ".orogen-7.tmp",
            ".orogen-a-0-0.tmp",
            ".orogen-7-0-0-0.tmp",
            "orogen-7-0-0.tmp",
            "mine.tmp",
        ] {
            fs::write(folder.join(name), "x").unwrap();
        }
        // A folder with such a name.
        fs::create_dir(folder.join(".orogen-5-0-0.tmp")).unwrap();
        // A running process holds its lock. A lock through another open file conflicts like a lock of another process.
        fs::write(folder.join(".orogen-8-0-0.tmp"), "x").unwrap();
        let alive = File::create(folder.join(".orogen-8-0.lock")).unwrap();
        alive.try_lock().unwrap();
        let kept = [
            ".orogen-5-0-0.tmp",
            ".orogen-7-0-0-0.tmp",
            ".orogen-7-0-0.tmp.bak",
            ".orogen-7.tmp",
            ".orogen-8-0-0.tmp",
            ".orogen-8-0.lock",
            ".orogen-a-0-0.tmp",
            "mine.tmp",
            "orogen-7-0-0.tmp",
        ];
        sweep(&folder);
        assert_eq!(names(&folder), kept);
        drop(alive);
        sweep(&folder);
        assert!(!names(&folder).iter().any(|name| name.starts_with(".orogen-8")), "its process has ended");
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn the_first_file_in_a_folder_sweeps_it_and_the_last_leaves_nothing() {
        let folder = folder("first");
        fs::write(folder.join(".orogen-1-0-0.tmp"), "x").unwrap();
        let (one, _) = Temporary::create(&folder).unwrap();
        let (other, _) = Temporary::create(&folder.join(".")).unwrap();
        assert_eq!(names(&folder).len(), 3, "one lock for both: {:?}", names(&folder));
        // Another process removes leftover files while these are in use.
        sweep(&folder);
        assert_eq!(names(&folder).len(), 3);
        drop(one);
        assert!(other.path().exists());
        other.rename(&folder.join("a")).unwrap();
        assert_eq!(names(&folder), ["a"]);
        fs::remove_dir_all(&folder).unwrap();
    }
}
