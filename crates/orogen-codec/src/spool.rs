//! Temporary storage for bytes whose position in a file is not known yet: in memory if there are few, otherwise on
//! disk.

use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use crate::fs::{self, File};
use crate::temporary::Temporary;

/// Number of bytes that are kept in memory: little compared with any `--memory`, and enough for small files.
pub const IN_MEMORY: usize = 8 << 20;

/// A file that can be written and read back.
trait Disk: Read + Write + Seek + Send {}

impl<T: Read + Write + Seek + Send> Disk for T {}

/// Temporary storage of bytes, which can be read in any order. Its file is removed on drop.
#[derive(Default)]
pub struct Spool {
    memory: Vec<u8>,
    /// The folder for the file that is needed for more than [`Spool::most`] bytes.
    folder: Option<PathBuf>,
    most: usize,
    /// Dropped before the name below, because some systems cannot remove open files.
    file: Option<Box<dyn Disk>>,
    /// The name of the file, if it could not be removed at once.
    name: Option<Temporary>,
    length: u64,
}

impl Spool {
    /// Keeps everything in memory.
    #[must_use]
    pub fn in_memory() -> Spool {
        Spool::default()
    }

    /// Keeps up to [`IN_MEMORY`] bytes in memory, and more in a file on the same disk as `path`. If `path` is a pipe or
    /// a device, the file is in the system's temporary folder.
    #[must_use]
    pub fn beside(path: &Path) -> Spool {
        Spool { folder: Some(folder_of(path)), most: IN_MEMORY, ..Spool::default() }
    }

    /// Keeps at most `most` bytes in memory.
    #[must_use]
    pub fn with_most(self, most: usize) -> Spool {
        Spool { most, ..self }
    }

    /// Number of stored bytes.
    #[must_use]
    pub fn length(&self) -> u64 {
        self.length
    }

    /// Stores bytes and returns their position for [`Spool::read`].
    pub fn push(&mut self, bytes: &[u8]) -> io::Result<u64> {
        let at = self.length;
        if self.file.is_none()
            && self.memory.len() + bytes.len() > self.most
            && let Some(folder) = &self.folder
        {
            let (mut file, name) = scratch(folder)?;
            file.write_all(&self.memory)?;
            self.memory = Vec::new();
            self.file = Some(Box::new(file));
            self.name = name;
        }
        match &mut self.file {
            Some(file) => file.write_all(bytes)?,
            None => self.memory.extend_from_slice(bytes),
        }
        self.length += bytes.len() as u64;
        Ok(at)
    }

    /// Reads bytes that are stored at `at`. No more bytes can be stored afterwards.
    pub fn read(&mut self, at: u64, bytes: &mut [u8]) -> io::Result<()> {
        if let Some(file) = &mut self.file {
            file.seek(SeekFrom::Start(at))?;
            return file.read_exact(bytes);
        }
        let start = usize::try_from(at).map_err(|_| io::ErrorKind::UnexpectedEof)?;
        let kept = self.memory.get(start..).and_then(|rest| rest.get(..bytes.len()));
        bytes.copy_from_slice(kept.ok_or(io::ErrorKind::UnexpectedEof)?);
        Ok(())
    }
}

/// Stores the written bytes.
impl Write for Spool {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.push(bytes).map(|_| bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// The folder for a temporary file that will be copied to `path`.
fn folder_of(path: &Path) -> PathBuf {
    match fs::canonicalize(path) {
        Ok(real) if fs::is_file(&real) => fs::folder(&real).to_path_buf(),
        Ok(_) => fs::temporary_folder(),
        Err(_) => fs::folder(path).to_path_buf(),
    }
}

/// A new file. If the system allows it, the file has no name, so that it is removed even if the process is killed.
fn scratch(folder: &Path) -> io::Result<(File, Option<Temporary>)> {
    let (name, file) = Temporary::create(folder)?;
    Ok((file, name.unlink()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Cursor;

    /// Accepts `left` bytes, then fails like a full disk.
    struct Full {
        disk: Cursor<Vec<u8>>,
        left: usize,
    }

    impl Read for Full {
        fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
            self.disk.read(bytes)
        }
    }

    impl Seek for Full {
        fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
            self.disk.seek(to)
        }
    }

    impl Write for Full {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            if bytes.len() > self.left {
                return Err(io::ErrorKind::StorageFull.into());
            }
            self.left -= bytes.len();
            self.disk.write(bytes)
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    fn fill_and_read(mut spool: Spool) {
        let pieces: Vec<Vec<u8>> = (0..20u8).map(|n| vec![n; 3 * usize::from(n)]).collect();
        let places: Vec<u64> = pieces.iter().map(|piece| spool.push(piece).unwrap()).collect();
        for (piece, at) in pieces.iter().zip(&places).rev() {
            let mut bytes = vec![99; piece.len()];
            spool.read(*at, &mut bytes).unwrap();
            assert_eq!(bytes, *piece);
        }
        for at in [spool.length, u64::MAX] {
            assert!(spool.read(at, &mut [0]).is_err());
        }
    }

    #[test]
    fn what_is_put_aside_comes_back_from_memory_and_from_disk() {
        let folder = std::env::temp_dir().join(format!("orogen-spool-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        fill_and_read(Spool::in_memory());
        for most in [0, 1, 100, 1000] {
            fill_and_read(Spool { folder: Some(folder.clone()), most, ..Spool::default() });
            assert_eq!(fs::read_dir(&folder).unwrap().count(), 0, "nothing is left");
        }
        fs::remove_dir(&folder).unwrap();
    }

    #[test]
    fn a_full_disk_is_an_error() {
        let disk = Full { disk: Cursor::default(), left: 10 };
        let mut spool = Spool { file: Some(Box::new(disk)), ..Spool::default() };
        assert!(spool.push(&[1; 10]).is_ok() && spool.push(&[2]).is_err());
        let gone = std::env::temp_dir().join(format!("orogen-no-such-{}", std::process::id()));
        let mut spool = Spool { folder: Some(gone), ..Spool::default() };
        assert!(spool.push(&[]).is_ok() && spool.push(&[1]).is_err());
    }

    #[test]
    fn a_pipe_or_a_device_has_no_disk_beside_it() {
        let folder = std::env::temp_dir();
        assert_eq!(folder_of(&folder.join("none").join("not-yet-there.tif")), folder.join("none"));
        assert_eq!(folder_of(Path::new("a.tif")), PathBuf::from("."));
        #[cfg(unix)]
        assert_eq!(folder_of(Path::new("/dev/null")), folder);
    }
}
