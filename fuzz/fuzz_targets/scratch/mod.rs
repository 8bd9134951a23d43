//! Where targets write files: in memory, if the system has a folder for that.
#![allow(dead_code, reason = "targets use some of it")]

use std::path::{Path, PathBuf};

/// A path of this process alone, with this ending.
pub fn path(ending: &str) -> PathBuf {
    let folder = Path::new("/dev/shm");
    let folder = if folder.is_dir() { folder.to_path_buf() } else { std::env::temp_dir() };
    folder.join(format!("orogen-fuzz-{}{ending}", std::process::id()))
}

/// Writes the parts of an input, which lines of `---` separate, to these files of a folder. Files without a part are removed.
pub fn write_parts(folder: &Path, names: &[&str], bytes: &[u8]) {
    let mut rest = Some(bytes);
    for name in names {
        let part = rest.and_then(|bytes| {
            let end = bytes.windows(5).position(|part| part == b"\n---\n");
            rest = end.map(|end| &bytes[end + 5..]);
            Some(&bytes[..end.unwrap_or(bytes.len())]).filter(|part| !part.is_empty())
        });
        let path = folder.join(name);
        match part {
            Some(part) => std::fs::write(&path, part).expect("a file is written"),
            None => drop(std::fs::remove_file(&path)),
        }
    }
}
