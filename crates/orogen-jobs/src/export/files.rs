//! The output of an export: either a file with its sidecars, written all or none, or a stream.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use orogen_grid::progress::Progress;
use orogen_io::file::cancellable::CancellableWriter;
use orogen_io::file::{self, Existing, Output, Staged};
use orogen_io::fs;
use orogen_io::spool::Spool;

/// The files of one export.
pub struct Files<'a> {
    sink: Sink<'a>,
    progress: Progress,
    /// Files that are written but not yet in place.
    staged: Vec<Staged>,
}

enum Sink<'a> {
    File(&'a Output),
    Stream(&'a mut dyn Write),
}

impl<'a> Files<'a> {
    /// A file at `output`, and its sidecars. Writing stops when `progress` is cancelled.
    pub fn at(output: &'a Output, progress: &Progress) -> Files<'a> {
        Files { sink: Sink::File(output), progress: progress.clone(), staged: Vec::new() }
    }

    /// A stream, such as standard output, without sidecars.
    pub fn stream(out: &'a mut dyn Write, progress: &Progress) -> Files<'a> {
        Files { sink: Sink::Stream(out), progress: progress.clone(), staged: Vec::new() }
    }

    /// The path of the file; `None` for a stream.
    pub fn path(&self) -> Option<&Path> {
        match &self.sink {
            Sink::File(output) => Some(output.path()),
            Sink::Stream(_) => None,
        }
    }

    /// Whether files of any kind may be replaced.
    pub fn replaces_all(&self) -> bool {
        matches!(&self.sink, Sink::File(output) if output.policy().existing() == Existing::Replace)
    }

    /// A spool for temporary data, on the disk of the file.
    pub fn spool(&self) -> Spool {
        match &self.sink {
            Sink::File(output) => Spool::beside(output.path()),
            // A stream has no disk of its own.
            Sink::Stream(_) => Spool::beside(&fs::temporary_folder().join("orogen")),
        }
    }

    /// Writes the main file.
    pub fn write(&mut self, body: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
        match &mut self.sink {
            Sink::Stream(out) => body(&mut CancellableWriter { out: &mut **out, progress: &self.progress }),
            Sink::File(output) => {
                let staged = file::stage(output, |out| body(&mut CancellableWriter { out, progress: &self.progress }))?;
                self.staged.push(staged);
                Ok(())
            }
        }
    }

    /// Writes a sidecar; `name` derives its path from the main file's path. Nothing is written for a stream, a pipe or
    /// a device.
    pub fn write_beside(
        &mut self,
        name: impl FnOnce(&Path) -> PathBuf,
        body: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> io::Result<()> {
        let Sink::File(output) = &self.sink else { return Ok(()) };
        let path = output.path();
        if fs::is_present(path) && !fs::is_file(path) {
            return Ok(());
        }
        let beside = output.policy().output(name(path))?;
        let staged = file::stage(&beside, |out| body(&mut CancellableWriter { out, progress: &self.progress }))?;
        self.staged.push(staged);
        Ok(())
    }

    /// Puts all files in place: first the sidecars, then the main file, whose presence means that the export is
    /// complete.
    pub(super) fn commit(self) -> io::Result<()> {
        self.progress.check()?;
        Ok(file::commit(self.staged.into_iter().rev().collect())?)
    }
}

/// The path with a suffix before its extension.
pub fn suffixed(path: &Path, suffix: &str) -> PathBuf {
    let mut name = path.file_stem().unwrap_or_default().to_os_string();
    name.push(suffix);
    if let Some(extension) = path.extension() {
        name.push(".");
        name.push(extension);
    }
    path.with_file_name(name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_io::file::OutputPolicy;
    use orogen_io::test_folder::TestFolder;

    #[test]
    fn all_files_appear_or_none() {
        let folder = TestFolder::new("files").unwrap();
        let path = folder.join("a.png");
        let progress = Progress::none();
        let both = |fail: bool| -> io::Result<()> {
            let output = OutputPolicy::default().output(&path)?;
            let mut files = Files::at(&output, &progress);
            files.write(|out| out.write_all(b"one"))?;
            files.write_beside(
                |path| path.with_extension("json"),
                |out| match fail {
                    true => Err(io::ErrorKind::StorageFull.into()),
                    false => out.write_all(b"two"),
                },
            )?;
            assert!(!path.exists());
            files.commit()
        };
        assert!(both(true).unwrap_err().to_string().contains("a.json"));
        assert!(folder.names().is_empty());
        both(false).unwrap();
        assert_eq!(folder.names(), ["a.json", "a.png"]);
    }

    #[test]
    fn what_is_not_wanted_any_more_leaves_nothing() {
        let folder = TestFolder::new("files").unwrap();
        let progress = Progress::none();
        let output = OutputPolicy::default().output(folder.join("a.png")).unwrap();
        let mut files = Files::at(&output, &progress);
        files.write(|out| out.write_all(b"one")).unwrap();
        progress.cancel();
        assert!(files.write_beside(|path| path.with_extension("json"), |out| out.write_all(b"two")).is_err());
        assert!(files.commit().is_err());
        assert!(folder.names().is_empty());
    }

    #[test]
    fn nothing_stands_beside_a_stream() {
        let (mut bytes, progress) = (Vec::new(), Progress::none());
        let mut files = Files::stream(&mut bytes, &progress);
        assert!(files.path().is_none());
        files.write(|out| out.write_all(b"one")).unwrap();
        files.write_beside(Path::to_path_buf, |_| Err(io::ErrorKind::Other.into())).unwrap();
        files.commit().unwrap();
        assert_eq!(bytes, b"one");
    }
}
