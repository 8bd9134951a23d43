//! The journal of a build, one line per entry.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use serde::{Deserialize, Serialize};

use super::digest::FileDigest;
use super::identity::Identity;
use super::job::{Job, Record};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_io::fs::{self, File, OpenOptions};

/// A line: JSON, a tab and the first digits of the JSON's SHA-256, so that truncated and damaged lines are detected.
#[derive(Debug, Serialize, Deserialize)]
enum Line {
    /// The first line.
    #[serde(rename = "build")]
    Begun(Identity),
    /// A completed job: stage, row, column; length and checksum of each file; ranges as the bits of two f32, which may
    /// be infinite.
    #[serde(rename = "tile")]
    Done([usize; 3], Vec<(u64, String)>, Vec<[u32; 2]>),
    /// The number of parts that make the result together.
    #[serde(rename = "parts")]
    Parts(usize),
    /// The build is complete. Lists the files that belong to no tile, by their paths within the result.
    #[serde(rename = "finished")]
    Finished(Vec<(PathBuf, u64, String)>),
}

/// Number of digits of the SHA-256 in a line.
const CHECK: usize = 16;

/// The content of a journal.
#[derive(Debug, Clone, PartialEq)]
pub struct JournalState {
    /// The identity of the build.
    pub identity: Identity,
    /// The completed jobs.
    pub records: BTreeMap<Job, Record>,
    /// The number of parts that make the result together; `None` if one process makes it.
    pub parts: Option<usize>,
    /// The files that belong to no tile, if the build is complete.
    pub finished: Option<Vec<(PathBuf, FileDigest)>>,
}

impl JournalState {
    /// The state of a new build.
    #[must_use]
    pub fn begun(identity: Identity) -> JournalState {
        JournalState { identity, records: BTreeMap::new(), parts: None, finished: None }
    }

    /// Reads the journal at `path`; `None` if there is none. Damaged or truncated lines after the first are ignored.
    ///
    /// # Errors
    /// If it cannot be read, or its first line is not the first line of a journal.
    pub fn read(path: &Path) -> Result<Option<JournalState>> {
        let bytes = match fs::read(path) {
            Ok(bytes) => bytes,
            Err(cause) if cause.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(cause) => return Err(Error::file("read", path, &cause)),
        };
        JournalState::parse(&bytes).map(Some).ok_or_else(|| {
            let message = format!(
                "the header of {} is damaged, so the build cannot be resumed; use --force, without --resume, to start again",
                path.display()
            );
            Error::new(ErrorKind::File, message)
        })
    }

    /// The state in the bytes of a journal; `None` if the first line is not valid.
    #[must_use]
    pub fn parse(bytes: &[u8]) -> Option<JournalState> {
        let mut lines = bytes.split(|byte| *byte == b'\n').map(parse);
        let Some(Some(Line::Begun(identity))) = lines.next() else { return None };
        let mut state = JournalState::begun(identity);
        for line in lines.flatten() {
            match line {
                Line::Begun(_) => {}
                Line::Parts(count) => state.parts = Some(count),
                Line::Done([stage, row, column], files, ranges) => {
                    let digests = files.into_iter().map(|(length, sha256)| FileDigest { length, sha256 }).collect();
                    let ranges = ranges.into_iter().map(|range| range.map(f32::from_bits)).collect();
                    state.records.insert(Job { stage, row, column }, Record { digests, ranges });
                }
                Line::Finished(files) => {
                    let files = files.into_iter().map(|(path, length, sha256)| (path, FileDigest { length, sha256 }));
                    state.finished = Some(files.collect());
                }
            }
        }
        Some(state)
    }

    fn lines(&self) -> impl Iterator<Item = Line> {
        let begun = Line::Begun(self.identity.clone());
        let done = self.records.iter().map(|(job, record)| done(*job, record));
        let finished = self.finished.iter().map(|files| {
            let files = files.iter().map(|(path, digest)| (path.clone(), digest.length, digest.sha256.clone()));
            Line::Finished(files.collect())
        });
        std::iter::once(begun).chain(self.parts.map(Line::Parts)).chain(done).chain(finished)
    }
}

fn done(job: Job, record: &Record) -> Line {
    let files = record.digests.iter().map(|digest| (digest.length, digest.sha256.clone())).collect();
    let ranges = record.ranges.iter().map(|range| range.map(f32::to_bits)).collect();
    Line::Done([job.stage, job.row, job.column], files, ranges)
}

fn text(line: &Line) -> io::Result<String> {
    let json = serde_json::to_string(line)?;
    let check = FileDigest::of(json.as_bytes()).sha256;
    Ok(format!("{json}\t{}\n", &check[..CHECK]))
}

fn parse(line: &[u8]) -> Option<Line> {
    let (json, check) = line.split_at_checked(line.len().checked_sub(CHECK + 1)?)?;
    let expect = FileDigest::of(json).sha256;
    let check = check.strip_prefix(b"\t")?;
    (check == &expect.as_bytes()[..CHECK]).then(|| serde_json::from_slice(json).ok())?
}

/// A journal that is open for writing.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    file: Mutex<File>,
}

impl Journal {
    /// Writes a journal with `state` that replaces an existing one, and opens it for appending. `temporary` is a path
    /// in the same folder that no other process uses.
    ///
    /// # Errors
    /// If it cannot be written, or if it is a new object and another process was faster.
    pub fn write(path: &Path, temporary: &Path, state: &JournalState) -> Result<Journal> {
        let put = || -> io::Result<File> {
            let mut all = String::new();
            for line in state.lines() {
                all.push_str(&text(&line)?);
            }
            if fs::is_remote(path) {
                // A store has no locks: of two builds that begin at the same time, one is refused.
                match fs::is_file(path) {
                    true => fs::write(path, all)?,
                    false => fs::write_new(path, all)?,
                }
            } else {
                let mut file = File::create(temporary)?;
                file.write_all(all.as_bytes())?;
                file.sync_all()?;
                fs::rename(temporary, path)?;
            }
            OpenOptions::new().append(true).open(path)
        };
        let file = put().map_err(|cause| match cause.kind() {
            io::ErrorKind::AlreadyExists => Error::new(
                ErrorKind::File,
                format!("another process has just begun {}; start again to continue its build", path.display()),
            ),
            _ => Error::file("write", path, &cause),
        })?;
        Ok(Journal { path: path.to_path_buf(), file: Mutex::new(file) })
    }

    /// Records a completed job, from any thread.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn enter(&self, job: Job, record: &Record) -> Result<()> {
        let put = || -> io::Result<()> {
            let text = text(&done(job, record))?;
            self.file.lock().unwrap_or_else(PoisonError::into_inner).write_all(text.as_bytes())
        };
        put().map_err(|cause| Error::file("write", &self.path, &cause))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_grid::grid::Window;
    use orogen_io::test_folder::TestFolder;

    fn state() -> JournalState {
        let identity = Identity {
            version: "1.2.3".into(),
            form: "zarr".into(),
            recipe: "aa".into(),
            layers: vec!["height".into(), "\t\n".into()],
            units: vec![String::new(); 2],
            window: Window::new(5, 6, 0.1 + 0.2).at(-3, 1 << 52),
            tile: 512,
            map: None,
        };
        let mut state = JournalState { parts: Some(7), ..JournalState::begun(identity) };
        for n in 0..4usize {
            let digests = (0..n).map(|k| FileDigest::of(&vec![0; k])).collect();
            let ranges = vec![[n as f32 / 3.0, f32::NEG_INFINITY]; n];
            state.records.insert(Job { stage: n % 2, row: n, column: 7 }, Record { digests, ranges });
        }
        state
    }

    #[test]
    fn a_story_comes_back_and_ends_where_it_was_cut() {
        let folder = TestFolder::new("journal").unwrap();
        let (path, temporary) = (folder.join("journal"), folder.join("tmp"));
        assert_eq!(JournalState::read(&path).unwrap(), None);
        let mut state = state();
        let journal = Journal::write(&path, &temporary, &state).unwrap();
        assert_eq!(JournalState::read(&path).unwrap().as_ref(), Some(&state));
        // Entries added one by one read the same as entries written at once.
        let (job, record) = (Job { stage: 9, row: 1, column: 2 }, Record { digests: vec![], ranges: vec![] });
        journal.enter(job, &record).unwrap();
        state.records.insert(job, record);
        assert_eq!(JournalState::read(&path).unwrap().as_ref(), Some(&state));
        state.finished = Some(vec![("a/b".into(), FileDigest::of(b"x"))]);
        Journal::write(&path, &temporary, &state).unwrap();
        assert_eq!(JournalState::read(&path).unwrap().as_ref(), Some(&state));
        // Truncated after the first line, it contains fewer jobs, but never different ones.
        let bytes = fs::read(&path).unwrap();
        let first = bytes.iter().position(|byte| *byte == b'\n').unwrap();
        for end in first..bytes.len() {
            fs::write(&path, &bytes[..end]).unwrap();
            let cut = JournalState::read(&path).unwrap().unwrap();
            assert!(cut.records.iter().all(|(job, record)| state.records.get(job) == Some(record)), "{end}");
            assert!(cut.records.len() <= state.records.len() && (cut.finished.is_none() || end + 1 == bytes.len()));
        }
        for end in 0..first {
            fs::write(&path, &bytes[..end]).unwrap();
            assert!(
                JournalState::read(&path)
                    .unwrap_err()
                    .to_string()
                    .contains("use --force, without --resume, to start again"),
                "{end}"
            );
        }
        // A flipped bit invalidates its own line only.
        for at in first + 1..bytes.len() {
            let mut other = bytes.clone();
            other[at] ^= 1;
            fs::write(&path, &other).unwrap();
            let read = JournalState::read(&path).unwrap().unwrap();
            assert!(read.records.iter().all(|(job, record)| state.records.get(job) == Some(record)), "{at}");
        }
    }
}
