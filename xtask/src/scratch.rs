//! A folder in memory for the files of tests: writing them to a disk, with the program waiting for it, would take a
//! large part of the time of a run.

use std::path::{Path, PathBuf};

use crate::shell;

/// The folder of Linux's file system in memory.
const MEMORY: &str = "/dev/shm";

/// Minimum free space in it, in KiB.
const FREE_KIB: u64 = 4 << 20;

/// A new folder in memory, which is removed with its files when this is dropped.
pub struct Scratch {
    path: PathBuf,
}

impl Scratch {
    /// A new folder; `None` if there is no file system in memory, or too little free space in it.
    pub fn new() -> Option<Scratch> {
        let report = shell::capture(shell::program("df").args(["-Pk", MEMORY])).ok()?;
        if !cfg!(target_os = "linux") || free_kib(&report)? < FREE_KIB {
            return None;
        }
        let path = Path::new(MEMORY).join(format!("orogen-tests-{}", std::process::id()));
        shell::empty_dir(&path).ok()?;
        Some(Scratch { path })
    }

    /// The path.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        // Files that cannot be removed use memory, but no test fails because of them.
        let _ = std::fs::remove_dir_all(&self.path);
    }
}

/// The free space in KiB according to `df -Pk`, if the folder is a separate file system in memory.
fn free_kib(report: &str) -> Option<u64> {
    let words: Vec<&str> = report.lines().nth(1)?.split_whitespace().collect();
    (words.first() == Some(&"tmpfs") && words.last() == Some(&MEMORY)).then_some(())?;
    words.get(3)?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reports_of_df() {
        let head = "Filesystem     1024-blocks  Used Available Capacity Mounted on\n";
        let free = |line: &str| free_kib(&format!("{head}{line}\n"));
        assert_eq!(free("tmpfs             12343464     8  12343456       1% /dev/shm"), Some(12_343_456));
        assert_eq!(free("/dev/vda         264073680 12000  80000000      13% /"), None);
        assert_eq!(free_kib(""), None);
    }

    #[test]
    fn a_folder_is_removed_with_its_files() {
        let Some(scratch) = Scratch::new() else { return };
        let path = scratch.path().to_owned();
        shell::write(&path.join("a.txt"), "a").expect("written");
        drop(scratch);
        assert!(!path.exists());
    }
}
