//! Where targets write files: in memory, if the system has a folder for that.

use std::ops::Deref;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

/// A new folder, which is removed with all that is in it when this is dropped.
pub struct Scratch(PathBuf);

impl Scratch {
    /// A folder for a target.
    pub fn new(target: &str) -> Scratch {
        static COUNT: AtomicUsize = AtomicUsize::new(0);
        let count = COUNT.fetch_add(1, Ordering::Relaxed);
        let memory = Path::new("/dev/shm");
        let folder = if memory.is_dir() { memory.to_path_buf() } else { std::env::temp_dir() };
        let folder = folder.join(format!("orogen-fuzz-{target}-{}-{count}", std::process::id()));
        // From a killed process with the same number.
        let _ = std::fs::remove_dir_all(&folder);
        std::fs::create_dir_all(&folder).expect("the folder is made");
        Scratch(folder)
    }

    /// Writes the parts of an input, which lines of `---` separate, to these files. Files without a part are removed.
    pub fn write_parts(&self, names: &[impl AsRef<Path>], bytes: &[u8]) {
        let mut rest = Some(bytes);
        for name in names {
            let part = rest.and_then(|bytes| {
                let end = bytes.windows(5).position(|part| part == b"\n---\n");
                rest = end.map(|end| &bytes[end + 5..]);
                Some(&bytes[..end.unwrap_or(bytes.len())]).filter(|part| !part.is_empty())
            });
            let path = self.join(name);
            match part {
                Some(part) => std::fs::write(&path, part).expect("a file is written"),
                None => drop(std::fs::remove_file(&path)),
            }
        }
    }
}

impl Deref for Scratch {
    type Target = Path;

    fn deref(&self) -> &Path {
        &self.0
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}
