//! Atomic writing of files.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::Temporary;
use super::policy::Output;
use crate::fs::{self, File, OpenOptions, Permissions, folder};
use orogen_codec::buffered::Buffered;
use orogen_grid::error::{Error, ErrorKind, Result};

/// Large enough to make system calls rare, small enough for any memory budget.
const BUFFER: usize = 256 * 1024;

/// Writes the file at `output` atomically, with the content that `body` writes.
///
/// If `body` fails with an I/O error, the result is a message with the file's name. If it fails with an [`Error`]
/// (through `?` or `into`), the result is that error.
///
/// ```
/// # fn main() -> orogen_grid::Result<()> {
/// use orogen_io::file::{OutputPolicy, write_whole};
///
/// let path = std::env::temp_dir().join(format!("orogen-doc-{}.txt", std::process::id()));
/// write_whole(&OutputPolicy::default().output(&path)?, |out| out.write_all(b"all of it"))?;
/// # std::fs::remove_file(&path).ok();
/// # Ok(())
/// # }
/// ```
pub fn write_whole<'a>(output: &Output, body: impl FnOnce(&mut dyn Write) -> io::Result<()> + 'a) -> Result<()> {
    stage(output, body)?.commit()
}

/// Writes a temporary file in the folder of `output` with the content that `body` writes, and syncs it.
/// [`Staged::commit`] puts it in place.
///
/// A pipe or device is written directly.
pub fn stage<'a>(output: &Output, body: impl FnOnce(&mut dyn Write) -> io::Result<()> + 'a) -> Result<Staged> {
    output.check(None)?;
    stage_through(output.path(), Some(output), |file| Box::new(file), Box::new(body))
}

/// [`write_whole`] over any existing file, for files whose names only this library uses.
pub fn replace_whole<'a>(path: &Path, body: impl FnOnce(&mut dyn Write) -> io::Result<()> + 'a) -> Result<()> {
    stage_through(path, None, |file| Box::new(file), Box::new(body))?.commit()
}

/// Like [`replace_whole`], but does not wait for the disk: after a crash of the system the file may be damaged. For
/// files that contain checksums and can be made again.
pub fn replace_unsynced<'a>(path: &Path, body: impl FnOnce(&mut dyn Write) -> io::Result<()> + 'a) -> Result<()> {
    stage_as(false, path, None, |file| Box::new(file), Box::new(body))?.commit()
}

/// Puts files that belong together in place, or none of them if one may not be replaced.
pub fn commit(files: Vec<Staged>) -> Result<()> {
    files.iter().try_for_each(Staged::check)?;
    files.into_iter().try_for_each(Staged::commit)
}

/// Checks that files can be created in `folder`, by creating and removing one. A folder of objects is not checked.
pub fn check_folder(folder: &Path) -> Result<()> {
    if fs::is_remote(folder) {
        return Ok(());
    }
    let refuse = |why: &str| Error::new(ErrorKind::File, format!("cannot write into {}: {why}", folder.display()));
    match fs::metadata(folder) {
        Ok(there) if !there.is_dir() => Err(refuse("it is not a folder")),
        Ok(_) => match Temporary::create(folder) {
            Ok(_) => Ok(()),
            // /proc and similar: the folder exists, but files cannot be created in it.
            Err(cause) if cause.kind() == io::ErrorKind::NotFound => Err(refuse("it does not allow new files")),
            Err(cause) => Err(Error::file("write into", folder, &cause)),
        },
        Err(cause) if cause.kind() == io::ErrorKind::NotFound => Err(refuse("the folder does not exist")),
        Err(cause) => Err(Error::file("write into", folder, &cause)),
    }
}

/// A file that is written but not yet in place. It is removed if dropped without [`Staged::commit`].
#[derive(Debug)]
pub struct Staged {
    path: PathBuf,
    /// The policy for replacing; `None` if any file may be replaced.
    output: Option<Output>,
    /// The temporary file and the target's real path; `None` for a pipe or device, which was written directly.
    file: Option<(Temporary, PathBuf)>,
    /// Whether the file survives a crash of the system.
    synced: bool,
}

impl Staged {
    /// Puts the file in place, replacing an existing one.
    ///
    /// # Errors
    /// If a file that may not be replaced has appeared there, or the system call fails.
    pub fn commit(self) -> Result<()> {
        self.check()?;
        if let Some((temporary, real)) = self.file {
            let put = match self.output.is_some_and(|output| output.keeps()) {
                true => temporary.rename_new(&real),
                false => temporary.rename(&real),
            };
            put.map_err(|cause| Error::file("write", &self.path, &cause))?;
            if self.synced {
                sync_folder(folder(&real));
            }
        }
        Ok(())
    }

    fn check(&self) -> Result<()> {
        match (&self.output, &self.file) {
            (Some(output), Some((temporary, _))) => output.check(Some(temporary.path())),
            _ => Ok(()),
        }
    }
}

/// The error for `cause`, which occurred while `doing` something ("read", "write") to `path`: the [`Error`] inside it
/// if it contains one, otherwise a message.
#[must_use]
pub fn explain(doing: &str, path: &Path, cause: &io::Error) -> Error {
    match cause.get_ref().and_then(|inner| inner.downcast_ref::<Error>()) {
        Some(error) => error.clone(),
        None => Error::file(doing, path, cause),
    }
}

/// The target of a write.
enum Destination {
    /// A file to replace: its path with links resolved, and the permissions of the existing one.
    File { real: PathBuf, permissions: Option<Permissions> },
    /// A pipe or device.
    Stream,
}

/// The function that writes the content of a file. It is boxed, so that all files share one copy of the code that
/// stages them.
type Body<'a> = Box<dyn FnOnce(&mut dyn Write) -> io::Result<()> + 'a>;

/// [`stage`], with `wrap` around the file, through which tests inject faults.
fn stage_through(
    path: &Path,
    output: Option<&Output>,
    wrap: impl for<'f> FnOnce(&'f File) -> Box<dyn Write + 'f>,
    body: Body,
) -> Result<Staged> {
    stage_as(true, path, output, wrap, body)
}

/// [`stage_through`]; the file is synced if required.
fn stage_as(
    synced: bool,
    path: &Path,
    output: Option<&Output>,
    wrap: impl for<'f> FnOnce(&'f File) -> Box<dyn Write + 'f>,
    body: Body,
) -> Result<Staged> {
    let failed = |cause: io::Error| Error::file("write", path, &cause);
    let file = match target(path)? {
        Destination::Stream => {
            let file = OpenOptions::new().write(true).open(path).map_err(failed)?;
            fill(path, wrap(&file), body)?;
            None
        }
        Destination::File { real, permissions } => {
            let (temporary, file) = match Temporary::create(folder(&real)) {
                Ok(created) => created,
                // The folder does not exist or does not accept files.
                Err(cause) if cause.kind() == io::ErrorKind::NotFound => {
                    return check_folder(folder(&real)).and(Err(failed(cause)));
                }
                Err(cause) => return Err(failed(cause)),
            };
            if let Some(permissions) = permissions {
                // Some file systems do not support permissions; errors are ignored.
                let _ = file.set_permissions(permissions);
            }
            fill(path, wrap(&file), body)?;
            if synced {
                file.sync_all().map_err(failed)?;
            }
            Some((temporary, real))
        }
    };
    Ok(Staged { path: path.to_path_buf(), output: output.cloned(), file, synced })
}

/// Determines what `path` is, and rejects paths that cannot be written.
fn target(path: &Path) -> Result<Destination> {
    let refuse = |why: &str| Error::new(ErrorKind::File, format!("cannot write {}: {why}", path.display()));
    let ends_in_separator = path.to_string_lossy().ends_with(std::path::is_separator);
    match fs::metadata(path) {
        Ok(there) if there.is_dir() => Err(refuse("it is a folder")),
        Ok(there) if there.is_file() => {
            if there.permissions().readonly() {
                return Err(refuse("it is marked read-only"));
            }
            match fs::canonicalize(path) {
                Ok(real) => Ok(Destination::File { real, permissions: Some(there.permissions()) }),
                // Another process has removed it since.
                Err(cause) if cause.kind() == io::ErrorKind::NotFound => {
                    Ok(Destination::File { real: path.to_path_buf(), permissions: None })
                }
                Err(cause) => Err(Error::file("write", path, &cause)),
            }
        }
        Ok(_) => Ok(Destination::Stream),
        Err(cause) if cause.kind() == io::ErrorKind::NotFound => {
            // Another file may have appeared there since.
            if fs::symlink_metadata(path).is_ok_and(|there| there.is_symlink()) {
                return Err(refuse("it is a link to something that does not exist"));
            }
            if path.file_name().is_none() || ends_in_separator {
                return Err(refuse("it does not name a file"));
            }
            Ok(Destination::File { real: path.to_path_buf(), permissions: None })
        }
        Err(cause) => Err(Error::file("write", path, &cause)),
    }
}

/// Runs `body` on a buffer over `file`. A failure of the file itself takes precedence over the error of `body`, and is
/// reported even if `body` ignored it.
fn fill(path: &Path, file: Box<dyn Write + '_>, body: Body) -> Result<()> {
    let mut failure = None;
    let done = {
        let mut file = Noting { path, inner: file, failure: &mut failure };
        let mut out = Buffered::new(&mut file, BUFFER);
        let done = body(&mut out).and_then(|()| out.flush());
        // Buffered data must not be written again after a failure.
        out.discard();
        done
    };
    match (failure, done) {
        (Some(failure), _) => Err(failure),
        (None, Err(cause)) => Err(explain("write", path, &cause)),
        (None, Ok(())) => Ok(()),
    }
}

/// A writer that records the first failure of the inner one.
struct Noting<'a> {
    path: &'a Path,
    inner: Box<dyn Write + 'a>,
    failure: &'a mut Option<Error>,
}

impl Noting<'_> {
    fn note<T>(&mut self, result: io::Result<T>) -> io::Result<T> {
        if let Err(cause) = &result
            && cause.kind() != io::ErrorKind::Interrupted
            && self.failure.is_none()
        {
            *self.failure = Some(Error::file("write", self.path, cause));
        }
        result
    }
}

impl Write for Noting<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let result = self.inner.write(bytes);
        self.note(result)
    }

    fn flush(&mut self) -> io::Result<()> {
        let result = self.inner.flush();
        self.note(result)
    }
}

/// Makes a rename in a folder durable. Some systems cannot open or sync folders, and the files are in place in any
/// case, so failures are ignored.
pub fn sync_folder(folder: &Path) {
    if !fs::is_remote(folder)
        && let Ok(folder) = File::open(folder)
    {
        let _ = folder.sync_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::file::{Existing, OutputPolicy};

    struct Folder(PathBuf);

    fn write_whole(path: &Path, body: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
        super::write_whole(&OutputPolicy::new(Existing::Replace).output(path)?, body)
    }

    fn stage(path: &Path, body: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<Staged> {
        super::stage(&OutputPolicy::new(Existing::Replace).output(path)?, body)
    }

    impl Folder {
        fn new(name: &str) -> Folder {
            let path = std::env::temp_dir().join(format!("orogen-file-{}-{name}", std::process::id()));
            let _ = fs::remove_dir_all(&path);
            fs::create_dir_all(&path).unwrap();
            Folder(path)
        }

        fn names(&self) -> Vec<String> {
            let mut names: Vec<String> =
                fs::read_dir(&self.0).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
            names.sort();
            names
        }
    }

    impl Drop for Folder {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    /// Accepts `left` bytes, then fails like a full disk.
    struct Full<'f> {
        file: &'f File,
        left: usize,
    }

    impl Write for Full<'_> {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            if self.left == 0 && !bytes.is_empty() {
                return Err(io::ErrorKind::StorageFull.into());
            }
            let take = bytes.len().min(self.left);
            self.left -= take;
            self.file.write(&bytes[..take])
        }

        fn flush(&mut self) -> io::Result<()> {
            self.file.flush()
        }
    }

    fn write_through(
        path: &Path,
        wrap: impl for<'f> FnOnce(&'f File) -> Box<dyn Write + 'f>,
        body: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<()> {
        stage_through(path, None, wrap, Box::new(body))?.commit()
    }

    #[test]
    fn a_disk_that_fills_up_at_any_byte_leaves_the_old_file() {
        let folder = Folder::new("full");
        let path = folder.0.join("a.bin");
        write_whole(&path, |out| out.write_all(b"old")).unwrap();
        let text = b"a body of some length, written in pieces";
        for n in 0..text.len() {
            // Pieces whose lengths differ from that of the buffer, so that their boundaries differ.
            let error = write_through(
                &path,
                |file| Box::new(Full { file, left: n }),
                |out| text.chunks(7).try_for_each(|piece| out.write_all(piece)),
            )
            .unwrap_err();
            assert_eq!(error.kind(), ErrorKind::File);
            assert!(error.to_string().starts_with(&format!("cannot write {}: ", path.display())), "{error}");
            assert_eq!(fs::read(&path).unwrap(), b"old", "after {n} bytes");
            assert_eq!(folder.names(), ["a.bin"], "after {n} bytes");
        }
        write_through(&path, |file| Box::new(Full { file, left: text.len() }), |out| out.write_all(text)).unwrap();
        assert_eq!(fs::read(&path).unwrap(), text);
    }

    #[test]
    fn a_failure_inside_a_large_body_leaves_nothing() {
        let folder = Folder::new("large");
        let path = folder.0.join("a.bin");
        let piece = vec![7u8; 100_000];
        for n in [0, 1, BUFFER - 1, BUFFER, BUFFER + 1, 999_999] {
            let result = write_through(
                &path,
                |file| Box::new(Full { file, left: n }),
                |out| (0..10).try_for_each(|_| out.write_all(&piece)),
            );
            assert!(result.is_err());
            assert_eq!(folder.names(), [] as [&str; 0], "after {n} bytes");
        }
    }

    #[test]
    fn a_swallowed_failure_is_still_a_failure() {
        let folder = Folder::new("swallowed");
        let path = folder.0.join("a.bin");
        let result = write_through(
            &path,
            |file| Box::new(Full { file, left: 10 }),
            |out| {
                let _ = out.write_all(&vec![0; 2 * BUFFER]);
                Ok(())
            },
        );
        assert!(result.is_err());
        assert_eq!(folder.names(), [] as [&str; 0]);
    }

    #[test]
    fn a_body_that_fails_leaves_the_old_file_and_its_own_error() {
        let folder = Folder::new("body");
        let path = folder.0.join("a.bin");
        write_whole(&path, |out| out.write_all(b"old")).unwrap();
        let error = write_whole(&path, |out| {
            out.write_all(b"half")?;
            Err(Error::new(ErrorKind::Cancelled, "stopped").into())
        })
        .unwrap_err();
        assert_eq!((error.kind(), error.to_string().as_str()), (ErrorKind::Cancelled, "stopped"));
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(folder.names(), ["a.bin"]);
    }

    #[test]
    fn a_target_that_becomes_a_folder_meanwhile_is_an_error() {
        let folder = Folder::new("becomes");
        let path = folder.0.join("a.bin");
        let error = write_whole(&path, |out| {
            fs::create_dir(&path)?;
            out.write_all(b"new")
        })
        .unwrap_err();
        assert_eq!(error.kind(), ErrorKind::File);
        assert_eq!(folder.names(), ["a.bin"]);
        assert!(path.is_dir());
    }

    #[test]
    fn targets_that_cannot_be_written_are_sentences() {
        let folder = Folder::new("targets");
        fs::write(folder.0.join("file"), "x").unwrap();
        fs::create_dir(folder.0.join("folder")).unwrap();
        let check = |name: &str, expect: &str| {
            let path = folder.0.join(name);
            let error = write_whole(&path, |out| out.write_all(b"new")).unwrap_err();
            let expect = format!("cannot write {}: {expect}", path.display());
            assert!(error.to_string().starts_with(&expect), "{error} / {expect}");
        };
        check("folder", "it is a folder");
        check("new/", "it does not name a file");
        let error = write_whole(&folder.0.join("missing/a"), |out| out.write_all(b"new")).unwrap_err();
        let expect = format!("cannot write into {}: the folder does not exist", folder.0.join("missing").display());
        assert_eq!(error.to_string(), expect);
        check("file/a", "");
        assert_eq!(folder.names(), ["file", "folder"]);
    }

    #[test]
    fn a_read_only_file_is_left_alone() {
        let folder = Folder::new("read-only");
        let path = folder.0.join("a");
        fs::write(&path, "old").unwrap();
        let mut permissions = std::fs::metadata(&path).unwrap().permissions();
        permissions.set_readonly(true);
        std::fs::set_permissions(&path, permissions).unwrap();
        let error = write_whole(&path, |out| out.write_all(b"new")).unwrap_err();
        assert!(error.to_string().ends_with("it is marked read-only"), "{error}");
        assert_eq!(fs::read(&path).unwrap(), b"old");
    }

    /// /proc rejects new files even from root, which ignores the permissions of ordinary folders.
    #[cfg(target_os = "linux")]
    #[test]
    fn a_folder_that_takes_no_files_is_a_sentence() {
        let error = write_whole(Path::new("/proc/orogen.png"), |out| out.write_all(b"new")).unwrap_err();
        assert!(error.to_string().starts_with("cannot write"), "{error}");
    }

    #[cfg(unix)]
    #[test]
    fn links_are_followed_and_kept() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = Folder::new("links");
        let (real, link) = (folder.0.join("real"), folder.0.join("link"));
        fs::write(&real, "old").unwrap();
        std::fs::set_permissions(&real, std::fs::Permissions::from_mode(0o640)).unwrap();
        symlink("real", &link).unwrap();
        write_whole(&link, |out| out.write_all(b"new")).unwrap();
        assert_eq!(fs::read(&real).unwrap(), b"new");
        assert_eq!(std::fs::metadata(&real).unwrap().permissions().mode() & 0o777, 0o640);
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        symlink("nowhere", folder.0.join("dangling")).unwrap();
        let error = write_whole(&folder.0.join("dangling"), |out| out.write_all(b"new")).unwrap_err();
        assert!(error.to_string().ends_with("it is a link to something that does not exist"), "{error}");
        assert_eq!(folder.names(), ["dangling", "link", "real"]);
    }

    #[cfg(unix)]
    #[test]
    fn a_device_is_written_and_stays_a_device() {
        write_whole(Path::new("/dev/null"), |out| out.write_all(b"gone")).unwrap();
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
    }

    #[test]
    fn what_is_staged_and_dropped_leaves_no_trace() {
        let folder = Folder::new("staged");
        let path = folder.0.join("a");
        write_whole(&path, |out| out.write_all(b"old")).unwrap();
        let staged = stage(&path, |out| out.write_all(b"new")).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"old");
        drop(staged);
        assert_eq!(folder.names(), ["a"]);
        stage(&path, |out| out.write_all(b"new")).unwrap().commit().unwrap();
        assert_eq!((fs::read(&path).unwrap(), folder.names()), (b"new".to_vec(), vec!["a".to_string()]));
    }

    #[test]
    fn folders_are_checked_without_a_trace() {
        let folder = Folder::new("check");
        check_folder(&folder.0).unwrap();
        assert_eq!(folder.names(), [] as [&str; 0]);
        fs::write(folder.0.join("file"), "x").unwrap();
        for (name, expect) in [("file", "it is not a folder"), ("none", ""), ("file/none", "")] {
            let path = folder.0.join(name);
            let error = check_folder(&path).unwrap_err().to_string();
            assert!(error.starts_with(&format!("cannot write into {}: {expect}", path.display())), "{error}");
        }
        #[cfg(target_os = "linux")]
        assert!(check_folder(Path::new("/proc")).is_err());
    }

    #[test]
    fn the_longest_name_works() {
        let folder = Folder::new("long");
        let path = folder.0.join("n".repeat(255));
        write_whole(&path, |out| out.write_all(b"new")).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
    }
}
