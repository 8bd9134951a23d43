//! Watches the file of the document, so that the window need not be drawn again just to look at it.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::Duration;

use orogen::{Error, ErrorKind, Result};

use crate::files;
use crate::platform;
use crate::preview::worker::Wake;

/// Time between two looks at the file.
const PAUSE: Duration = Duration::from_millis(500);

/// A thread that looks at a file from time to time. It ends with this value.
#[derive(Debug)]
pub struct FileWatch {
    paths: Sender<Option<PathBuf>>,
}

impl FileWatch {
    /// Starts the thread, without a file. `wake` is called when the file has changed.
    ///
    /// # Errors
    /// If the thread cannot be started.
    pub fn new(wake: Wake) -> Result<FileWatch> {
        let (paths, given) = channel::<Option<PathBuf>>();
        let watch = move || {
            let (mut path, mut known) = (None, None);
            loop {
                // Without a file there is nothing to look at.
                let next = match &path {
                    Some(_) => given.recv_timeout(PAUSE),
                    None => given.recv().map_err(|_| RecvTimeoutError::Disconnected),
                };
                match next {
                    Ok(next) => {
                        known = next.as_deref().and_then(files::changed);
                        path = next;
                    }
                    Err(RecvTimeoutError::Timeout) => {
                        let now = path.as_deref().and_then(files::changed);
                        if now != known {
                            known = now;
                            wake();
                        }
                    }
                    Err(RecvTimeoutError::Disconnected) => return,
                }
            }
        };
        platform::watch("file watch", watch)
            .map_err(|cause| Error::new(ErrorKind::File, format!("cannot start a thread: {cause}")))?;
        Ok(FileWatch { paths })
    }

    /// Watches another file, or none.
    pub fn watch(&self, path: Option<&Path>) {
        // The thread lives as long as the sender.
        let _ = self.paths.send(path.map(Path::to_path_buf));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen::io::test_folder::TestFolder;
    use std::sync::Arc;

    #[test]
    fn a_changed_file_is_told_once() {
        let folder = TestFolder::new("studio-file-watch").unwrap();
        let path = folder.join("a.toml");
        files::write(&path, "1").unwrap();
        let (sender, told) = channel();
        let wake: Wake = Arc::new(move || {
            // The test may have ended.
            let _ = sender.send(());
        });
        let watch = FileWatch::new(wake).unwrap();
        watch.watch(Some(&path));
        assert!(told.recv_timeout(PAUSE * 3).is_err(), "nothing has changed");
        // The thread may not have looked at the file before the first change.
        let is_told = (1..30).any(|n| {
            let later = std::time::SystemTime::now() + Duration::from_secs(60 * n);
            std::fs::File::options().append(true).open(&path).unwrap().set_modified(later).unwrap();
            told.recv_timeout(Duration::from_secs(2)).is_ok()
        });
        assert!(is_told);
        assert!(told.recv_timeout(PAUSE * 3).is_err(), "it was told");
        drop(watch);
        assert!(told.recv_timeout(Duration::from_secs(60)).is_err(), "the thread has ended");
    }
}
