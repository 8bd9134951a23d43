//! A folder of solutions, shared by later runs and other processes.
//!
//! An entry is a file named by the hash of its key: the solver's content key and the version of this library. It is
//! written atomically and verified completely when it is read; a damaged entry is computed again. Reading makes an
//! entry the most recent one; if the folder exceeds its limit, the oldest entries are removed. Several processes may
//! share a folder: a file that one of them removes stays readable for those that have it open.

use super::entry;
use crate::op::Solution;
use crate::plan::key::Key;
use orogen_grid::hex;
use orogen_io::file;
use sha2::{Digest, Sha256};
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

/// A cache of solutions between runs.
#[derive(Debug, Clone, PartialEq)]
pub struct Cache {
    /// The folder; created if it does not exist. Only the cache's own files in it are changed.
    pub folder: PathBuf,
    /// Maximum size of all entries, in bytes.
    pub limit: u64,
    /// Solutions that took less time to compute are not cached.
    pub slower_than: Duration,
}

impl Cache {
    /// A cache in `folder` of at most 10 GiB, for solutions that took longer than 0.25 s.
    pub fn new(folder: impl Into<PathBuf>) -> Cache {
        Cache { folder: folder.into(), limit: 10 << 30, slower_than: Duration::from_millis(250) }
    }

    /// The system's cache folder for Orogen, if it is known: `$XDG_CACHE_HOME/orogen` or `~/.cache/orogen`,
    /// `~/Library/Caches/orogen` on macOS, `%LOCALAPPDATA%\orogen\cache` on Windows.
    #[must_use]
    pub fn system_folder() -> Option<PathBuf> {
        let absolute = |name: &str| std::env::var_os(name).map(PathBuf::from).filter(|path| path.is_absolute());
        if cfg!(windows) {
            return absolute("LOCALAPPDATA").map(|path| path.join("orogen").join("cache"));
        }
        let home = std::env::home_dir().filter(|path| path.is_absolute());
        if cfg!(target_os = "macos") {
            return home.map(|path| path.join("Library/Caches/orogen"));
        }
        absolute("XDG_CACHE_HOME").or_else(|| home.map(|path| path.join(".cache"))).map(|path| path.join("orogen"))
    }

    /// The solution stored under `key`, if there is an intact one.
    pub(crate) fn find(&self, key: &Key, on_disk: bool) -> Option<Solution> {
        let (name, path) = self.place(key);
        let file = File::open(&path).ok()?;
        match entry::read(file, &path, &name, on_disk) {
            Ok(solution) => {
                // It was just used, so it is removed last. If its time cannot be set, it is removed a little early.
                if let Ok(file) = File::options().append(true).open(&path) {
                    let _ = file.set_modified(SystemTime::now());
                }
                Some(solution)
            }
            Err(_) => {
                let _ = fs::remove_file(&path);
                None
            }
        }
    }

    /// Whether there is an entry under `key`, intact or not.
    pub(crate) fn has(&self, key: &Key) -> bool {
        self.place(key).1.is_file()
    }

    /// Stores a solution, and removes the oldest ones if the limit is exceeded. Failures are ignored, because the
    /// solution is in memory.
    pub(crate) fn keep(&self, key: &Key, solution: &Solution) {
        if entry::length(solution) > self.limit || fs::create_dir_all(&self.folder).is_err() {
            return;
        }
        let (name, path) = self.place(key);
        let _ = file::replace_whole(&path, |out| entry::write(out, &name, solution));
        self.tidy(&path);
    }

    fn place(&self, key: &Key) -> (Key, PathBuf) {
        let mut hash = Sha256::new();
        hash.update(key);
        hash.update(env!("CARGO_PKG_VERSION"));
        let name: Key = hash.finalize().into();
        (name, self.folder.join(hex::encode(&name) + EXTENSION))
    }

    /// The key in the name of an entry; `None` for other names.
    pub(super) fn key_of(name: &str) -> Option<Key> {
        hex::decode(name.strip_suffix(EXTENSION)?)
    }

    /// Removes the oldest entries beyond the limit, but not `newest`, and incomplete files of killed processes.
    fn tidy(&self, newest: &Path) {
        file::sweep(&self.folder);
        let Ok(there) = fs::read_dir(&self.folder) else { return };
        let mut entries: Vec<(SystemTime, u64, PathBuf)> = Vec::new();
        for file in there.flatten() {
            let (name, Ok(meta)) = (file.file_name(), file.metadata()) else { continue };
            let (name, used) = (name.to_string_lossy(), meta.modified().unwrap_or(SystemTime::UNIX_EPOCH));
            if Cache::key_of(&name).is_some() {
                entries.push((used, meta.len(), file.path()));
            }
        }
        entries.sort();
        let mut total: u64 = entries.iter().map(|(_, length, _)| length).sum();
        for (_, length, path) in entries.iter().filter(|(_, _, path)| path != newest) {
            if total <= self.limit {
                return;
            }
            let _ = fs::remove_file(path);
            total -= length;
        }
    }
}

const EXTENSION: &str = ".solved";

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_grid::grid::{Grid, Window};
    use orogen_io::raster::Raster;

    struct Folder(PathBuf);

    impl Drop for Folder {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    fn cache(name: &str) -> (Folder, Cache) {
        let path = std::env::temp_dir().join(format!("orogen-cache-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        (Folder(path.clone()), Cache { slower_than: Duration::ZERO, ..Cache::new(path) })
    }

    fn solution(side: usize) -> Solution {
        let window = Window::new(side, side / 2, 0.1).at(-2, -2);
        let grid = |factor: f32| {
            let data = (0..window.len()).map(|k| k as f32 * factor).collect();
            Raster::in_memory(Grid::from_data(window, data).unwrap())
        };
        Solution { layers: vec![grid(0.37), grid(-1.0)], scalars: vec![1.5, f64::INFINITY] }
    }

    fn same(a: &Solution, b: &Solution) {
        assert_eq!(a.scalars, b.scalars);
        assert_eq!(a.layers.len(), b.layers.len());
        for (a, b) in a.layers.iter().zip(&b.layers) {
            assert_eq!(a.window(), b.window());
            assert_eq!(a.get(a.window()).unwrap(), b.get(b.window()).unwrap());
        }
    }

    #[test]
    fn what_is_kept_is_found_again() {
        let (_folder, cache) = cache("kept");
        let kept = solution(600);
        assert!(cache.find(&[1; 32], false).is_none());
        cache.keep(&[1; 32], &kept);
        for on_disk in [false, true] {
            let found = cache.find(&[1; 32], on_disk).unwrap();
            assert!(found.layers.iter().all(|layer| layer.is_on_disk() == on_disk));
            same(&kept, &found);
        }
        assert!(cache.find(&[2; 32], false).is_none());
        let numbers = Solution { layers: Vec::new(), scalars: vec![-7.0] };
        cache.keep(&[3; 32], &numbers);
        same(&numbers, &cache.find(&[3; 32], true).unwrap());
    }

    #[test]
    fn damage_is_found_and_removed() {
        let (_folder, cache) = cache("damage");
        let key = [7; 32];
        let path = cache.place(&key).1;
        cache.keep(&key, &solution(300));
        let sound = fs::read(&path).unwrap();
        // A flipped byte at any position, a truncated or extended file, another entry's file under this name.
        let mut damaged: Vec<Vec<u8>> =
            [0, 20, 50, 60, 70, 90, 200, 5000, sound.len() / 2, sound.len() - 9, sound.len() - 1]
                .map(|at| {
                    let mut bytes = sound.clone();
                    bytes[at] ^= 0x10;
                    bytes
                })
                .into();
        damaged.extend([0, 1, 63, 300, sound.len() - 1].map(|length| sound[..length].to_vec()));
        damaged.push([&sound[..], &[0]].concat());
        for bytes in damaged {
            for on_disk in [false, true] {
                fs::write(&path, &bytes).unwrap();
                assert!(cache.find(&key, on_disk).is_none());
                assert!(!path.exists(), "what is damaged is removed");
            }
        }
        cache.keep(&[8; 32], &solution(300));
        fs::rename(cache.place(&[8; 32]).1, &path).unwrap();
        assert!(cache.find(&key, false).is_none());
        cache.keep(&key, &solution(300));
        same(&solution(300), &cache.find(&key, true).unwrap());
    }

    #[test]
    fn the_longest_unused_goes_first() {
        let (_folder, mut cache) = cache("limit");
        let one = solution(256);
        cache.limit = 5 * entry::length(&one) / 2;
        let old = |key: u8, seconds: u64| {
            let file = File::options().append(true).open(cache.place(&[key; 32]).1).unwrap();
            file.set_modified(SystemTime::now() - Duration::from_secs(seconds)).unwrap();
        };
        let there = |key: u8| cache.place(&[key; 32]).1.exists();
        cache.keep(&[1; 32], &one);
        old(1, 30);
        cache.keep(&[2; 32], &one);
        old(2, 20);
        assert!(cache.find(&[1; 32], true).is_some(), "used again");
        fs::write(cache.folder.join("mine.txt"), "not an entry").unwrap();
        let abandoned = cache.folder.join(".orogen-1-1-1.tmp");
        fs::write(&abandoned, [0; 99]).unwrap();
        cache.keep(&[3; 32], &one);
        assert_eq!([there(1), there(2), there(3)], [true, false, true]);
        assert!(cache.folder.join("mine.txt").exists() && !abandoned.exists());
        cache.keep(&[4; 32], &solution(2000));
        assert_eq!([there(1), there(3), there(4)], [true, true, false], "what is larger than the limit is not kept");
    }

    #[test]
    fn many_at_once_neither_break_nor_see_halves() {
        let (_folder, cache) = cache("many");
        let kept = solution(300);
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| {
                    for round in 0..20 {
                        cache.keep(&[round % 3; 32], &kept);
                        if let Some(found) = cache.find(&[round % 3; 32], round % 2 == 0) {
                            same(&kept, &found);
                        }
                        if round % 5 == 0 {
                            let _ = fs::remove_file(cache.place(&[round % 3; 32]).1);
                        }
                    }
                });
            }
        });
    }
}
