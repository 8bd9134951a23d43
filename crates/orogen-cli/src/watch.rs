//! Watching files and repeating work when they change.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use orogen::recipe::document::LONGEST_TEXT;
use orogen::{ErrorKind, Progress, Recipe};

use crate::bar::Bar;
use crate::failure::Failure;
use crate::report::report;
use crate::{interrupt, say};

/// Interval between checks. Content is compared instead of time stamps, so touching a file has no effect.
const INTERVAL: Duration = Duration::from_millis(200);

/// Time for which a changed file must stay the same before it is read, because editors truncate files before they write
/// them.
const CALM: Duration = Duration::from_millis(50);

/// Number of checks for which a missing file is not a change, because some editors replace files by removing them
/// first.
const PATIENCE: u32 = 5;

/// Calls `make` now and after each change of the recipe at `path` or of a recipe that it uses, forever. Outdated work
/// is cancelled. Failures are reported and watching continues, unless the output is closed.
pub fn watch(
    path: &Path,
    quiet: bool,
    mut make: impl FnMut(&Progress) -> Result<String, Failure>,
) -> Result<(), Failure> {
    let mut seen = Seen::look(path);
    loop {
        let (bar, progress) = Bar::new(quiet);
        let made = until_changed(&seen, &progress, || make(&progress));
        drop(bar);
        match made {
            Ok(text) => say::out(&text)?,
            Err(Failure::Engine(error)) if error.kind() == ErrorKind::Cancelled && !interrupt::asked() => {
                seen.settle(path);
                continue;
            }
            Err(Failure::BrokenPipe) => return Err(Failure::BrokenPipe),
            Err(_) if interrupt::asked() => {}
            Err(failure) => report(&failure),
        }
        if !quiet && !interrupt::asked() {
            say::error(&format!("watching {}; Ctrl-C ends", path.display()));
        }
        while !interrupt::asked() && !seen.changed() {
            std::thread::sleep(INTERVAL);
        }
        if interrupt::asked() {
            return Err(interrupt::stopped("stopped watching"));
        }
        seen.settle(path);
    }
}

/// Runs `work`, and cancels it if the file changes meanwhile.
fn until_changed<T>(seen: &Seen, progress: &Progress, work: impl FnOnce() -> T) -> T {
    let finished = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let looker = scope.spawn(|| {
            while !finished.load(Ordering::Relaxed) {
                if seen.clone().changed() {
                    progress.cancel();
                    return;
                }
                std::thread::park_timeout(INTERVAL);
            }
        });
        let done = work();
        finished.store(true, Ordering::Relaxed);
        looker.thread().unpark();
        done
    })
}

/// The last content of the recipe's file and of the recipes that it uses.
#[derive(Debug, Clone, PartialEq)]
struct Seen(Vec<SeenFile>);

/// The last content of a file.
#[derive(Debug, Clone, PartialEq)]
struct SeenFile {
    path: PathBuf,
    content: Option<Vec<u8>>,
    missed: u32,
}

/// The content of a file, if it is not longer than a recipe may be.
fn read(path: &Path) -> Option<Vec<u8>> {
    orogen::io::open::bytes(path, "read the recipe", LONGEST_TEXT).ok().flatten()
}

impl Seen {
    fn look(path: &Path) -> Seen {
        let used = Recipe::read(path).map(|recipe| recipe.used().to_vec()).unwrap_or_default();
        Seen::look_at([path.to_path_buf()].into_iter().chain(used))
    }

    /// Reads all files.
    fn look_at(paths: impl Iterator<Item = PathBuf>) -> Seen {
        let mut files: Vec<SeenFile> = Vec::new();
        for path in paths {
            if !files.iter().any(|file| file.path == path) {
                files.push(SeenFile { content: read(&path), path, missed: 0 });
            }
        }
        Seen(files)
    }

    /// Waits until the files stop changing.
    fn settle(&mut self, path: &Path) {
        loop {
            let mut now = Seen::look(path);
            if now.0.len() == 1 {
                // An invalid recipe does not state which files it uses. The files of the last valid one are kept,
                // because the error may be in one of them.
                now = Seen::look_at(self.0.iter().map(|file| file.path.clone()));
            }
            *self = now;
            std::thread::sleep(CALM);
            if Seen::look_at(self.0.iter().map(|file| file.path.clone())) == *self {
                return;
            }
        }
    }

    /// Checks whether any file has changed.
    fn changed(&mut self) -> bool {
        // All files are checked, so that each is up to date.
        self.0.iter_mut().filter_map(|file| file.changed().then_some(())).count() > 0
    }
}

impl SeenFile {
    fn changed(&mut self) -> bool {
        let now = read(&self.path);
        if now == self.content {
            self.missed = 0;
            return false;
        }
        if now.is_none() && self.missed < PATIENCE {
            self.missed += 1;
            return false;
        }
        (self.content, self.missed) = (now, 0);
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen::io::test_folder::TestFolder;

    #[test]
    fn recipes_that_are_used_are_watched() {
        let folder = TestFolder::new("watch-used").unwrap();
        let part = |octaves: u32| {
            let text = format!("orogen = 1\n[nodes.n]\nop = \"fbm\"\noctaves = {octaves}\n[outputs]\nheight = \"n\"\n");
            std::fs::write(folder.join("part.toml"), text).unwrap();
        };
        let top = folder.join("top.toml");
        std::fs::write(&top, "orogen = 1\n[use.part]\nrecipe = \"part.toml\"\n[outputs]\nheight = \"part\"\n").unwrap();
        part(3);
        let mut seen = Seen::look(&top);
        assert_eq!(seen.0.len(), 2);
        assert!(!seen.changed());
        // An error in the used recipe, and its correction.
        part(99);
        assert!(seen.changed());
        seen.settle(&top);
        assert!(!seen.changed());
        part(4);
        assert!(seen.changed() && !seen.changed());
    }

    #[test]
    fn only_other_content_is_a_change() {
        let folder = TestFolder::new("watch").unwrap();
        let path = folder.join("a.toml");
        std::fs::write(&path, "a").unwrap();
        let mut seen = Seen::look(&path);
        assert!(!seen.changed());
        std::fs::write(&path, "a").unwrap();
        assert!(!seen.changed());
        std::fs::write(&path, "b").unwrap();
        assert!(seen.changed() && !seen.changed());
        std::fs::remove_file(&path).unwrap();
        for _ in 0..PATIENCE {
            assert!(!seen.changed());
        }
        assert!(seen.changed() && !seen.changed());
        std::fs::write(&path, "b").unwrap();
        assert!(seen.changed());
        std::fs::remove_file(&path).unwrap();
    }
}
