//! The files of a build on disk, and its lock.

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use super::job::JobFile;
use super::part_folder;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_io::file::{self, Output};
use orogen_io::fs::{self, File, TryLockError};

/// File names within the folder of the build.
const LOCK: &str = "lock";
const JOURNAL: &str = "journal";
const SCRATCH: &str = "scratch";
const TEMPORARY: &str = "temporary";
const PARTS: &str = "parts";

/// Files at the top of a folder that mark a completed build.
const MARKS: [&str; 3] = ["zarr.json", "manifest.json", "tiles.json"];

/// Number of files that are synced concurrently.
const SYNCS: usize = 16;

/// The paths of the result and of the folder next to it.
#[derive(Debug, Clone)]
pub struct WorkDir {
    /// The output, with its policy for replacing.
    output: Output,
    out: PathBuf,
    beside: PathBuf,
    /// The folder of temporary files of this process.
    temporary: PathBuf,
    /// Whether the result is a single file.
    file: bool,
}

/// The lock of a running build. The operating system releases it when the process ends, for whatever reason.
#[derive(Debug)]
pub struct BuildLock {
    _lock: File,
    beside: PathBuf,
    /// Whether the folder was created by this build.
    new: bool,
    /// Whether the folder contains something worth keeping.
    kept: bool,
}

impl BuildLock {
    /// Marks the folder as worth keeping.
    pub fn keep(&mut self) {
        self.kept = true;
    }
}

impl Drop for BuildLock {
    fn drop(&mut self) {
        if self.new && !self.kept {
            // A build that fails before it makes anything leaves no trace. Removes only empty files and folders.
            let _ = fs::remove_file(self.beside.join(LOCK));
            let _ = fs::remove_dir(&self.beside);
        }
    }
}

impl WorkDir {
    /// The work directory of a result at `out`.
    ///
    /// # Errors
    /// If `out` cannot be a result.
    pub fn new(output: &Output, is_file: bool) -> Result<WorkDir> {
        let out = output.path();
        let refuse = |why: &str| Err(Error::new(ErrorKind::File, format!("cannot build {}: {why}", out.display())));
        // Links are resolved, so that their targets are replaced and the links stay.
        let real = match fs::canonicalize(out) {
            Ok(real) => real,
            // Another part may have put the result there since.
            Err(_) if fs::symlink_metadata(out).is_ok_and(|there| there.is_symlink()) => {
                return refuse("it is a link to something that does not exist");
            }
            Err(_) => out.to_path_buf(),
        };
        let Some(name) = real.file_name() else {
            return refuse("it does not name a file or folder");
        };
        match fs::metadata(&real) {
            Ok(there) if is_file && there.is_dir() => return refuse("it is a folder"),
            Ok(there) if is_file && !there.is_file() => return refuse("it is not a regular file"),
            Ok(there) if is_file && there.permissions().readonly() => return refuse("it is marked read-only"),
            Ok(there) if !is_file && !there.is_dir() => return refuse("it is a file, and a folder is needed"),
            _ => {}
        }
        let mut beside = name.to_os_string();
        beside.push(".build");
        let beside = real.with_file_name(beside);
        let temporary = beside.join(TEMPORARY);
        Ok(WorkDir { output: output.clone(), beside, temporary, out: real, file: is_file })
    }

    /// The work directory of a part, which has temporary files of its own.
    pub fn for_part(self, number: usize) -> WorkDir {
        WorkDir { temporary: self.temporary.join(format!("part-{number}")), ..self }
    }

    /// Whether the files of the build are objects, which need no temporary files.
    pub fn is_remote(&self) -> bool {
        fs::is_remote(&self.out)
    }

    /// The folder of the parts' journals and locks.
    pub fn parts(&self) -> PathBuf {
        self.beside.join(PARTS)
    }

    /// The result.
    pub fn out(&self) -> &Path {
        &self.out
    }

    /// The output, with its policy for replacing.
    pub fn output(&self) -> &Output {
        &self.output
    }

    /// The folder next to the result, with the journal and temporary files.
    pub fn beside(&self) -> &Path {
        &self.beside
    }

    /// The journal.
    pub fn journal(&self) -> PathBuf {
        self.beside.join(JOURNAL)
    }

    /// A file of a job.
    pub fn path(&self, place: &JobFile) -> PathBuf {
        match place {
            JobFile::Result(path) => self.result(path),
            JobFile::Scratch(path) => self.beside.join(SCRATCH).join(path),
        }
    }

    /// The path of a file of the result; an empty path is the result itself.
    pub fn result(&self, path: &Path) -> PathBuf {
        if path.as_os_str().is_empty() { self.out.clone() } else { self.out.join(path) }
    }

    /// The path of a temporary file; each `n` gives a different path.
    pub fn temporary(&self, n: u64) -> PathBuf {
        self.temporary.join(n.to_string())
    }

    /// Creates the folder next to the result and locks it.
    ///
    /// # Errors
    /// If another build is running there, or the folder cannot be written.
    pub fn hold(&self) -> Result<BuildLock> {
        let (lock, new) = self.lock(|file| file.try_lock(), "another build")?;
        Ok(BuildLock { _lock: lock, beside: self.beside.clone(), new, kept: false })
    }

    /// Creates the folder next to the result and locks it for a part; other parts can lock it, too.
    ///
    /// # Errors
    /// If a whole build is running there, or the folder cannot be written.
    pub fn share(&self) -> Result<File> {
        Ok(self.lock(|file| file.try_lock_shared(), "a build without --part")?.0)
    }

    /// Creates the folder next to the result and locks it. Returns also whether the folder is new. `other` is the
    /// holder of a lock that excludes this one.
    fn lock(
        &self,
        try_lock: impl FnOnce(&File) -> std::result::Result<(), TryLockError>,
        other: &str,
    ) -> Result<(File, bool)> {
        file::check_folder(file::folder(&self.out))?;
        let new = match fs::create_dir(&self.beside) {
            Ok(()) => true,
            Err(cause) if cause.kind() == io::ErrorKind::AlreadyExists => false,
            Err(cause) => return Err(Error::file("make the folder", &self.beside, &cause)),
        };
        if let Some(foreign) = self.foreign_beside() {
            let message = format!(
                "{} holds {}, which was not made by a build, and a build of {} needs that folder; move it away, or choose another output",
                self.beside.display(),
                foreign.to_string_lossy(),
                self.out.display()
            );
            return Err(Error::new(ErrorKind::File, message));
        }
        let path = self.beside.join(LOCK);
        let failed = |cause: io::Error| Error::file("lock", &path, &cause);
        let lock = part_folder::open(&path).map_err(failed)?;
        match try_lock(&lock) {
            Ok(()) => Ok((lock, new)),
            Err(TryLockError::WouldBlock) => Err(Error::new(
                ErrorKind::File,
                format!("{other} of {} is running; wait until it ends, or choose another output", self.out.display()),
            )),
            Err(TryLockError::Error(cause)) => Err(failed(cause)),
        }
    }

    /// Whether the result's path is in use; an empty folder does not count.
    pub fn is_taken(&self) -> bool {
        if self.file {
            return fs::is_present(&self.out);
        }
        match fs::read_dir(&self.out) {
            Ok(mut entries) => entries.next().is_some(),
            // Not looked at again, because another part may have made the empty folder since.
            Err(cause) => cause.kind() != io::ErrorKind::NotFound,
        }
    }

    /// The error for a folder that is not the result of a build; `None` if the path is a result or a file.
    pub fn foreign(&self) -> Option<Error> {
        let is_built = self.file || MARKS.iter().any(|mark| fs::is_file(&self.out.join(mark)));
        let message = || {
            format!(
                "{} holds files that were not made by a build, which --force does not remove; empty the folder, or choose another output",
                self.out.display()
            )
        };
        (!is_built).then(|| Error::new(ErrorKind::File, message()))
    }

    /// A file in the folder next to the result that does not belong to a build.
    fn foreign_beside(&self) -> Option<OsString> {
        let names = fs::read_dir(&self.beside).ok()?.flatten().map(|entry| entry.file_name());
        names.filter(|name| ![LOCK, JOURNAL, SCRATCH, TEMPORARY, PARTS].iter().any(|own| name == own)).min()
    }

    /// Prepares a new build: removes the files of the previous one, whose paths within the result are `old`. Returns
    /// other files, which are kept. `known` is true if there is a journal, which proves that the result was made by a
    /// build; `new` are the files that will be written.
    ///
    /// A single file is not removed; it is replaced by the new one at the end.
    ///
    /// # Errors
    /// If the existing files were not made by a build, a file that is kept conflicts with a new one, or something
    /// cannot be removed. In the first two cases nothing is removed.
    pub fn clear(&self, known: bool, old: &BTreeSet<PathBuf>, new: &BTreeSet<PathBuf>) -> Result<Vec<PathBuf>> {
        let mut foreign = Vec::new();
        if !self.file && self.is_taken() {
            let refuse = |message: String| Err(Error::new(ErrorKind::File, message));
            if let Some(foreign) = self.foreign().filter(|_| !known) {
                return Err(foreign);
            }
            let (files, folders) = self.contents()?;
            let policy = self.output.policy();
            let (own, others): (Vec<PathBuf>, Vec<PathBuf>) =
                files.into_iter().partition(|path| old.contains(path) && !policy.is_input(&self.out.join(path)));
            if let Some(path) = others.iter().find(|path| new.contains(*path)) {
                return refuse(format!(
                    "{} was not made by a build and would be overwritten; move it away, or choose another output",
                    self.out.join(path).display()
                ));
            }
            // The journal first, because a partially removed result must not look resumable.
            remove(&self.journal(), |path| fs::remove_file(path))?;
            own.iter().try_for_each(|path| remove(&self.out.join(path), |path| fs::remove_file(path)))?;
            // The innermost first. Non-empty folders and empty folders that no build made are kept.
            let held: BTreeSet<&Path> = own.iter().flat_map(|path| path.ancestors().skip(1)).collect();
            let emptied = folders.iter().rev().filter(|folder| held.contains(folder.as_path()));
            emptied.for_each(|folder| drop(fs::remove_dir(self.out.join(folder))));
            foreign = others;
        }
        remove(&self.journal(), |path| fs::remove_file(path))?;
        self.sweep()?;
        Ok(foreign)
    }

    /// The files and folders within a result that is a folder, by their paths within it. Links count as files.
    fn contents(&self) -> Result<(Vec<PathBuf>, BTreeSet<PathBuf>)> {
        let (mut files, mut folders, mut left) = (Vec::new(), BTreeSet::new(), vec![PathBuf::new()]);
        while let Some(within) = left.pop() {
            let folder = self.out.join(&within);
            let failed = |cause: io::Error| Error::file("read", &folder, &cause);
            for entry in fs::read_dir(&folder).map_err(failed)? {
                let entry = entry.map_err(failed)?;
                let path = within.join(entry.file_name());
                match entry.file_type().map_err(failed)?.is_dir() {
                    true => {
                        folders.insert(path.clone());
                        left.push(path);
                    }
                    false => files.push(path),
                }
            }
        }
        files.sort();
        Ok((files, folders))
    }

    /// Removes temporary files of a completed build.
    ///
    /// # Errors
    /// If they cannot be removed.
    pub fn sweep(&self) -> Result<()> {
        [SCRATCH, TEMPORARY]
            .iter()
            .try_for_each(|name| remove(&self.beside.join(name), |path| fs::remove_dir_all(path)))?;
        self.drop_parts()
    }

    /// Removes the journals and locks of parts.
    ///
    /// # Errors
    /// If they cannot be removed.
    pub fn drop_parts(&self) -> Result<()> {
        remove(&self.parts(), |path| fs::remove_dir_all(path))
    }

    /// Removes incomplete files.
    ///
    /// # Errors
    /// If they cannot be removed.
    pub fn tidy(&self) -> Result<()> {
        remove(&self.temporary, |path| fs::remove_dir_all(path))
    }

    /// Creates the folders for files.
    ///
    /// # Errors
    /// If they cannot be created.
    pub fn furnish(&self) -> Result<()> {
        let make = |path: &Path| fs::create_dir_all(path).map_err(|cause| Error::file("make the folder", path, &cause));
        make(&self.temporary)?;
        if self.file { Ok(()) } else { make(&self.out) }
    }

    /// Makes files durable: syncs them and their folders.
    ///
    /// # Errors
    /// If a file cannot be synced.
    pub fn sync(&self, files: &[JobFile]) -> Result<()> {
        if self.is_remote() {
            // Objects are durable once they are written.
            return Ok(());
        }
        let paths: Vec<PathBuf> = files.iter().map(|file| self.path(file)).collect();
        let sync = |path: &PathBuf| {
            let synced = File::open(path).and_then(|file| file.sync_all());
            synced.map_err(|cause| Error::file("write", path, &cause))
        };
        // Waiting for a disk takes no CPU time, and file systems handle concurrent requests together.
        let next = AtomicUsize::new(0);
        let work = || {
            while let Some(path) = paths.get(next.fetch_add(1, Ordering::Relaxed)) {
                sync(path)?;
            }
            Ok(())
        };
        std::thread::scope(|scope| {
            let threads: Vec<_> = (0..SYNCS.min(paths.len())).map(|_| scope.spawn(work)).collect();
            let lost = || Error::new(ErrorKind::File, "a thread that synchronises files failed");
            threads.into_iter().try_for_each(|thread| thread.join().map_err(|_| lost())?)
        })?;
        let mut folders = BTreeSet::new();
        for path in &paths {
            let is_ours = |folder: &Path| folder.starts_with(&self.out) || folder.starts_with(&self.beside);
            let within = path.ancestors().skip(1).take_while(|folder| is_ours(folder));
            folders.extend(within.map(Path::to_path_buf));
        }
        folders.insert(file::folder(&self.out).to_path_buf());
        folders.insert(self.beside.clone());
        for folder in folders {
            file::sync_folder(&folder);
        }
        Ok(())
    }
}

/// Removes something that may not exist.
fn remove(path: &Path, how: impl FnOnce(&Path) -> io::Result<()>) -> Result<()> {
    match how(path) {
        Err(cause) if cause.kind() != io::ErrorKind::NotFound => Err(Error::file("remove", path, &cause)),
        _ => Ok(()),
    }
}
