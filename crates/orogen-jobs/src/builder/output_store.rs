//! The files of a build, written and verified by checksum.

use std::collections::BTreeMap;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{SyncSender, sync_channel};
use std::sync::{Mutex, PoisonError};

use super::digest::{FileDigest, Measured};
use super::job::{Job, JobFile, Made, Record};
use super::journal::Journal;
use super::work_dir::WorkDir;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_io::file;
use orogen_io::fs::{self, File};

/// Buffer size for an assembled file, in bytes.
const BUFFER: usize = 1 << 20;

/// Number of threads that send objects while others make tiles. Each waits for a server nearly all the time.
const SENDERS: usize = 8;

/// Number of tiles that wait to be sent or are being sent.
pub const WAITING: usize = 2 * SENDERS;

/// Writes the content of a file. Tests replace it to simulate a full disk.
pub type Put = dyn Fn(&Path, &[u8]) -> io::Result<()> + Send + Sync;

/// The files of a build and its journal.
pub struct OutputStore<'a> {
    work_dir: &'a WorkDir,
    journal: Journal,
    records: Mutex<BTreeMap<Job, Record>>,
    count: AtomicU64,
    put: &'a Put,
    /// Where tiles wait to be sent, while there are threads that send them.
    queue: Mutex<Option<SyncSender<Waiting>>>,
    /// The first failure of these threads.
    failure: Mutex<Option<Error>>,
}

/// A tile that waits to be sent.
type Waiting = (Job, Vec<JobFile>, Made);

impl<'a> OutputStore<'a> {
    /// Creates a store with the records of completed jobs.
    pub fn new(
        work_dir: &'a WorkDir,
        journal: Journal,
        records: BTreeMap<Job, Record>,
        put: &'a Put,
    ) -> OutputStore<'a> {
        let records = Mutex::new(records);
        let count = AtomicU64::new(0);
        OutputStore { work_dir, journal, records, count, put, queue: Mutex::default(), failure: Mutex::default() }
    }

    /// Does `work`, in which [`OutputStore::keep`] only queues tiles if they become objects: other threads send them.
    /// All are sent at the end.
    ///
    /// # Errors
    /// The errors of `work`, and of the files.
    pub fn sending<T>(&self, work: impl FnOnce() -> Result<T>) -> Result<T> {
        if !self.work_dir.is_remote() {
            return work();
        }
        let (queue, next) = sync_channel::<Waiting>(WAITING - SENDERS);
        let next = Mutex::new(next);
        let send = || {
            loop {
                let waiting = next.lock().unwrap_or_else(PoisonError::into_inner).recv();
                let Ok((job, places, made)) = waiting else { return };
                // After a failure the queue is emptied, so that nobody waits.
                if self.failed().is_none()
                    && let Err(error) = self.write(job, &places, &made)
                {
                    self.failure.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
                }
            }
        };
        std::thread::scope(|scope| {
            (0..SENDERS).for_each(|_| drop(scope.spawn(send)));
            self.set_queue(Some(queue));
            // Also after a panic, because the threads wait for its end.
            let _closed = ClosedAtEnd(self);
            work()
        })
        .and_then(|done| self.failed().map_or(Ok(done), Err))
    }

    fn set_queue(&self, queue: Option<SyncSender<Waiting>>) {
        *self.queue.lock().unwrap_or_else(PoisonError::into_inner) = queue;
    }

    fn failed(&self) -> Option<Error> {
        self.failure.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Writes the files of a job and records them in the journal, now or within [`OutputStore::sending`] later.
    ///
    /// # Errors
    /// If they cannot be written, or earlier ones could not.
    pub fn keep(&self, job: Job, places: Vec<JobFile>, made: Made) -> Result<()> {
        let queue = self.queue.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let Some(queue) = queue else { return self.write(job, &places, &made) };
        if let Some(error) = self.failed() {
            return Err(error);
        }
        let lost = || Error::new(ErrorKind::File, "the threads that send objects have ended");
        queue.send((job, places, made)).map_err(|_| lost())
    }

    fn write(&self, job: Job, places: &[JobFile], made: &Made) -> Result<()> {
        let mut digests = Vec::with_capacity(made.files.len());
        for (place, bytes) in places.iter().zip(&made.files) {
            digests.push(self.file(place, bytes)?);
        }
        let record = Record { digests, ranges: made.ranges.clone() };
        self.journal.enter(job, &record)?;
        self.records.lock().unwrap_or_else(PoisonError::into_inner).insert(job, record);
        Ok(())
    }

    /// Writes one file atomically.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn file(&self, place: &JobFile, bytes: &[u8]) -> Result<FileDigest> {
        let path = self.work_dir.path(place);
        let put = || {
            if self.work_dir.is_remote() {
                return (self.put)(&path, bytes);
            }
            let temporary = self.temporary();
            (self.put)(&temporary, bytes)?;
            settle(&temporary, &path)
        };
        put().map_err(|cause| Error::file("write", &path, &cause))?;
        Ok(FileDigest::of(bytes))
    }

    /// Writes a file of the result as indented JSON.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn json(&self, path: &str, value: &serde_json::Value) -> Result<(PathBuf, FileDigest)> {
        let path = PathBuf::from(path);
        let digest = self.file(&JobFile::Result(path.clone()), format!("{value:#}\n").as_bytes())?;
        Ok((path, digest))
    }

    /// Assembles a result that is a single file: `body` writes it; it is synced and then put in place.
    ///
    /// # Errors
    /// If it cannot be written, or `body` fails.
    pub fn assemble(&self, body: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<FileDigest> {
        if self.work_dir.is_remote() {
            return self.assemble_object(body);
        }
        let (path, temporary) = (self.work_dir.out(), self.temporary());
        let put = || -> io::Result<FileDigest> {
            let mut out = BufWriter::with_capacity(BUFFER, Measured::new(File::create(&temporary)?));
            body(&mut out)?;
            let (file, digest) = out.into_inner().map_err(io::IntoInnerError::into_error)?.end();
            if let Ok(there) = fs::metadata(path) {
                // Some file systems do not support permissions; errors are ignored.
                let _ = file.set_permissions(there.permissions());
            }
            file.sync_all()?;
            self.work_dir.output().check(Some(&temporary))?;
            settle(&temporary, path)?;
            Ok(digest)
        };
        put().map_err(|cause| file::explain("write", path, &cause))
    }

    /// [`OutputStore::assemble`] for an object, which is a file of the system until it is complete.
    fn assemble_object(&self, body: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<FileDigest> {
        let mut digest = FileDigest::of(&[]);
        file::write_whole(self.work_dir.output(), |out| {
            let mut measured = Measured::new(out);
            body(&mut measured)?;
            digest = measured.end().1;
            Ok(())
        })?;
        Ok(digest)
    }

    /// Reads a file of a job.
    ///
    /// # Errors
    /// If it cannot be read.
    pub fn read(&self, place: &JobFile, bytes: &mut Vec<u8>) -> io::Result<()> {
        use io::Read as _;
        bytes.clear();
        let path = self.work_dir.path(place);
        let explain = |cause: io::Error| io::Error::from(Error::file("read", &path, &cause));
        File::open(&path).and_then(|mut file| file.read_to_end(bytes)).map_err(explain)?;
        Ok(())
    }

    /// The path of a file of a job.
    pub fn path(&self, place: &JobFile) -> PathBuf {
        self.work_dir.path(place)
    }

    /// The record of a completed job.
    pub fn record(&self, job: Job) -> Option<Record> {
        self.records.lock().unwrap_or_else(PoisonError::into_inner).get(&job).cloned()
    }

    /// Minimum and maximum finite sample of a layer over all jobs; `None` if no sample is finite.
    pub fn range(&self, layer: usize) -> Option<[f32; 2]> {
        let records = self.records.lock().unwrap_or_else(PoisonError::into_inner);
        let ranges = records.values().filter_map(|record| record.ranges.get(layer));
        let [low, high] =
            ranges.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], [l, h]| [low.min(*l), high.max(*h)]);
        (low <= high).then_some([low, high])
    }

    /// All records.
    pub fn into_records(self) -> BTreeMap<Job, Record> {
        self.records.into_inner().unwrap_or_else(PoisonError::into_inner)
    }

    fn temporary(&self) -> PathBuf {
        self.work_dir.temporary(self.count.fetch_add(1, Ordering::Relaxed))
    }
}

/// Takes the queue of a store away when it is dropped.
struct ClosedAtEnd<'s, 'a>(&'s OutputStore<'a>);

impl Drop for ClosedAtEnd<'_, '_> {
    fn drop(&mut self) {
        self.0.set_queue(None);
    }
}

/// Writes a file.
pub fn put(path: &Path, bytes: &[u8]) -> io::Result<()> {
    fs::write(path, bytes)
}

/// Moves a file to its place; creates the folder if needed.
fn settle(temporary: &Path, path: &Path) -> io::Result<()> {
    match fs::rename(temporary, path) {
        Err(cause) if cause.kind() == io::ErrorKind::NotFound => {
            fs::create_dir_all(file::folder(path))?;
            fs::rename(temporary, path)
        }
        other => other,
    }
}
