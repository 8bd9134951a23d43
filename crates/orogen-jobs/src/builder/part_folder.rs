//! The files by which the parts of a build know of each other: a journal and a lock of each part, and a lock of all.
//!
//! A part never waits for another one to do its work. The lock of all parts is held for a moment when a part begins,
//! and while the result is finished.

use std::collections::BTreeSet;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

use super::identity::Identity;
use super::journal::JournalState;
use super::part::Part;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::progress::Progress;
use orogen_io::fs::{self, File, OpenOptions, TryLockError};

/// The lock of all parts.
const LOCK: &str = "lock";

/// Extensions: of the lock of a part, and of the journal of a complete part.
const PART_LOCK: &str = "lock";
const DONE: &str = "done";

/// Time between two attempts to get the lock of all parts.
const PAUSE: Duration = Duration::from_millis(50);

/// Up to this number of parts, all are looked at.
const ALL_SEEN: usize = 1000;

/// The folder, as one part sees it.
pub struct PartFolder {
    path: PathBuf,
    part: Part,
}

impl PartFolder {
    pub fn new(path: &Path, part: Part) -> PartFolder {
        PartFolder { path: path.to_path_buf(), part }
    }

    /// Creates the folder.
    ///
    /// # Errors
    /// If it cannot be created.
    pub fn create(&self) -> Result<()> {
        fs::create_dir_all(&self.path).map_err(|cause| Error::file("make the folder", &self.path, &cause))
    }

    /// The journal of a part that is not complete.
    pub fn journal(&self, number: usize) -> PathBuf {
        self.path.join(number.to_string())
    }

    /// The journal of a complete part.
    pub fn done(&self, number: usize) -> PathBuf {
        self.path.join(format!("{number}.{DONE}"))
    }

    /// Waits for the lock of all parts. `None` if the folder was removed, because the build has been finished.
    ///
    /// # Errors
    /// If the file system has no locks, or the work is cancelled.
    pub fn lock(&self, progress: &Progress) -> Result<Option<File>> {
        let path = self.path.join(LOCK);
        let file = match open(&path) {
            Ok(file) => file,
            Err(cause) if cause.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(cause) => return Err(Error::file("lock", &path, &cause)),
        };
        loop {
            match file.try_lock() {
                Ok(()) => return Ok(Some(file)),
                Err(TryLockError::WouldBlock) => std::thread::sleep(PAUSE),
                Err(TryLockError::Error(cause)) => return Err(Error::file("lock", &path, &cause)),
            }
            progress.check()?;
        }
    }

    /// Locks the part.
    ///
    /// # Errors
    /// If it is running.
    pub fn hold(&self, out: &Path) -> Result<File> {
        let Part { number, count } = self.part;
        let path = self.path.join(format!("{number}.{PART_LOCK}"));
        let failed = |cause: io::Error| Error::file("lock", &path, &cause);
        let file = open(&path).map_err(failed)?;
        match file.try_lock() {
            Ok(()) => Ok(file),
            Err(TryLockError::WouldBlock) => Err(Error::new(
                ErrorKind::File,
                format!("part {number} of {count} of {} is already running; wait until it ends", out.display()),
            )),
            Err(TryLockError::Error(cause)) => Err(failed(cause)),
        }
    }

    /// Whether the part is marked as complete.
    pub fn is_done(&self) -> bool {
        fs::is_file(&self.done(self.part.number))
    }

    /// The journal of the part, complete or not.
    pub fn own(&self, identity: &Identity) -> Option<JournalState> {
        let Part { number, .. } = self.part;
        read(&self.done(number), identity).or_else(|| read(&self.journal(number), identity))
    }

    /// Removes the mark that a part is complete; its journal stays.
    ///
    /// # Errors
    /// If it cannot be removed.
    pub fn revoke(&self, number: usize) -> Result<()> {
        let done = self.done(number);
        match fs::rename(&done, self.journal(number)) {
            Err(cause) if cause.kind() != io::ErrorKind::NotFound => Err(Error::file("rename", &done, &cause)),
            _ => Ok(()),
        }
    }

    /// The parts that are not marked as complete, in order. Of more than [`ALL_SEEN`] parts, perhaps not all of them.
    pub fn missing(&self) -> Vec<usize> {
        // A network file system may remember that a mark was absent. Opening the folder makes it ask again.
        let listing = fs::read_dir(&self.path);
        // Objects are listed in a few requests, but looked up one by one.
        let listed: Option<BTreeSet<PathBuf>> = fs::is_remote(&self.path)
            .then(|| listing.into_iter().flatten().flatten().map(|entry| entry.path()).collect());
        let is_done = |number: usize| match &listed {
            Some(listed) => listed.contains(&self.done(number)),
            None => fs::is_file(&self.done(number)),
        };
        let count = self.part.count;
        // Far apart, so that a missing part is soon found in whatever order the parts are run.
        let step = (1..=(count * 5).div_ceil(8)).rev().find(|step| divisor(*step, count) == 1).unwrap_or(1);
        let mut missing = Vec::new();
        for n in 0..count {
            if n >= ALL_SEEN && !missing.is_empty() {
                break;
            }
            let number = (n as u64 * step as u64 % count as u64) as usize + 1;
            if !is_done(number) {
                missing.push(number);
            }
        }
        missing.sort_unstable();
        missing
    }

    /// Removes the journals and marks of another build.
    ///
    /// # Errors
    /// If one cannot be removed.
    pub fn clear(&self) -> Result<()> {
        journals(&self.path)
            .try_for_each(|path| fs::remove_file(&path).map_err(|cause| Error::file("remove", &path, &cause)))
    }
}

/// Adds the records of all parts in the folder at `path` to those of their build.
pub fn merge(path: &Path, state: &mut JournalState) {
    for path in journals(path) {
        if let Some(part) = read(&path, &state.identity) {
            state.records.extend(part.records);
        }
    }
}

/// The journal of a part of this build; `None` if there is none, or its first line is damaged.
pub fn read(path: &Path, identity: &Identity) -> Option<JournalState> {
    JournalState::read(path).ok().flatten().filter(|state| state.identity == *identity)
}

/// The journals of parts in a folder.
fn journals(path: &Path) -> impl Iterator<Item = PathBuf> {
    let entries = fs::read_dir(path).into_iter().flatten().flatten();
    entries.map(|entry| entry.path()).filter(|path| {
        let is_lock = path.extension().is_some_and(|extension| extension == PART_LOCK);
        !is_lock && path.file_name().is_some_and(|name| name != LOCK)
    })
}

/// Opens a file to lock it; shared locks of network file systems need it open for reading.
pub fn open(path: &Path) -> io::Result<File> {
    OpenOptions::new().create(true).truncate(false).read(true).write(true).open(path)
}

/// The greatest common divisor.
fn divisor(a: usize, b: usize) -> usize {
    let (mut a, mut b) = (a, b);
    while b > 0 {
        (a, b) = (b, a % b);
    }
    a
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_io::test_folder::TestFolder;

    #[test]
    fn missing_parts_are_found() {
        let folder = TestFolder::new("parts").unwrap();
        for count in [1, 2, 5, 8, 64, 1500] {
            let parts = PartFolder::new(&folder, Part { number: 1, count });
            for number in 1..=count {
                std::fs::write(parts.done(number), "").unwrap();
            }
            assert_eq!(parts.missing(), [0usize; 0]);
            for number in [1, count / 2 + 1, count] {
                parts.revoke(number).unwrap();
                assert_eq!(parts.missing(), [number]);
                std::fs::write(parts.done(number), "").unwrap();
            }
        }
    }
}
