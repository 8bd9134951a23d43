//! A folder of solutions and tiles of levels, shared by later runs and other processes.
//!
//! An entry is a file named by the hash of its key: the content key, for a tile the level and its window, and the
//! version of this library. It is written atomically and verified completely when it is read; a damaged entry is
//! computed again. Reading makes an entry the most recent one; if the folder exceeds its limit, the oldest entries are
//! removed. Several processes may share a folder: a file that one of them removes stays readable for processes that
//! have it open.

use super::solution_store::{Entry, EntryKey, SolutionStore};
use orogen_io::file;
use orogen_io::fs::{self, File};
use orogen_io::read_at::{PositionedFile, ReadAt};
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

/// A folder of solutions and tiles of levels: a store for later runs and other processes.
#[derive(Debug, Clone, PartialEq)]
pub struct FolderStore {
    /// The folder; created if it does not exist. Only the store's own files in it are changed. A URL names a folder of
    /// an object store.
    pub folder: PathBuf,
    /// Maximum size of all entries, in bytes. While tiles of levels are stored, it may be exceeded by a few percent.
    /// In an object store it limits single entries only; old ones are removed by rules of the store.
    pub limit: u64,
    /// Minimum estimated time on one core of solutions that are stored. The tiles of levels of a request are stored if
    /// together they take at least a tenth of it. The time is an estimate, so the same solutions are stored on any
    /// machine.
    pub slower_than: Duration,
}

/// The environment variable with the folder of the cache; an empty value disables it.
const CACHE_VARIABLE: &str = "OROGEN_CACHE";

impl FolderStore {
    /// A store in `folder` of at most 10 GiB, for solutions that take more than about 0.25 s on one core.
    pub fn new(folder: impl Into<PathBuf>) -> FolderStore {
        FolderStore { folder: folder.into(), limit: 10 << 30, slower_than: Duration::from_millis(250) }
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

    /// The folder that is used unless another one is chosen: that of the environment variable `OROGEN_CACHE`,
    /// otherwise the [system's](FolderStore::system_folder); `None` if the variable is empty, or none is known.
    #[must_use]
    pub fn usual_folder() -> Option<PathBuf> {
        match std::env::var_os(CACHE_VARIABLE) {
            Some(folder) if folder.is_empty() => None,
            Some(folder) => Some(PathBuf::from(folder)),
            None => FolderStore::system_folder(),
        }
    }

    pub(super) fn path(&self, key: &EntryKey) -> PathBuf {
        self.folder.join(format!("{key}{EXTENSION}"))
    }

    /// The key in the name of an entry; `None` for other names.
    pub(super) fn key_of(name: &str) -> Option<EntryKey> {
        name.strip_suffix(EXTENSION)?.parse().ok()
    }

    /// Whether the folder is tidied after a tile is stored. Listing a folder takes longer than writing a tile, so this
    /// is done only after some tiles, chosen by their keys: about once per 64th of the limit.
    fn is_tidied_by(&self, key: &EntryKey, bytes: u64) -> bool {
        let chance = u64::from(u32::from_le_bytes([key.0[0], key.0[1], key.0[2], key.0[3]]));
        u128::from(chance) * u128::from(self.limit / 64) < u128::from(bytes) << 32
    }

    /// Removes the oldest entries beyond the limit, but not `newest`, and incomplete files of killed processes.
    fn tidy(&self, newest: &Path) {
        file::sweep(&self.folder);
        let Ok(there) = fs::read_dir(&self.folder) else { return };
        let mut entries: Vec<(SystemTime, u64, PathBuf)> = Vec::new();
        for file in there.flatten() {
            let (name, Ok(meta)) = (file.file_name(), file.metadata()) else { continue };
            let (name, used) = (name.to_string_lossy(), meta.modified().unwrap_or(SystemTime::UNIX_EPOCH));
            if FolderStore::key_of(&name).is_some() {
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

impl SolutionStore for FolderStore {
    fn get(&self, key: &EntryKey) -> io::Result<Option<Box<dyn ReadAt>>> {
        let path = self.path(key);
        let file = match File::open(&path) {
            Ok(file) => file,
            Err(cause) if cause.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(cause) => return Err(cause),
        };
        // It is used now, so it is removed last. If its time cannot be set, it is removed a little early.
        if !fs::is_remote(&path)
            && let Ok(file) = File::options().append(true).open(&path)
        {
            let _ = file.set_modified(SystemTime::now());
        }
        Ok(Some(Box::new(PositionedFile::new(file))))
    }

    fn put(&self, key: &EntryKey, entry: &Entry) -> io::Result<()> {
        if entry.length() > self.limit {
            return Ok(());
        }
        fs::create_dir_all(&self.folder)?;
        let path = self.path(key);
        // Others may have stored it since, which saves sending it.
        if fs::is_remote(&path) && fs::is_file(&path) {
            return Ok(());
        }
        // Waiting for the disk takes longer than making a tile, and a damaged tile is detected, so tiles are written
        // without waiting.
        let put = match entry.is_tile() {
            true => file::replace_unsynced(&path, |out| entry.write_to(out)),
            false => file::replace_whole(&path, |out| entry.write_to(out)),
        };
        let is_tidied = !entry.is_tile() || self.is_tidied_by(key, entry.length());
        if is_tidied && !fs::is_remote(&path) {
            self.tidy(&path);
        }
        put.map_err(io::Error::from)
    }

    fn contains(&self, key: &EntryKey) -> bool {
        fs::is_file(&self.path(key))
    }

    fn remove(&self, key: &EntryKey) -> io::Result<()> {
        match fs::remove_file(self.path(key)) {
            Err(cause) if cause.kind() != io::ErrorKind::NotFound => Err(cause),
            _ => Ok(()),
        }
    }

    fn slower_than(&self) -> Duration {
        self.slower_than
    }

    fn keeps_tiles(&self) -> bool {
        true
    }

    fn scratch_folder(&self) -> Option<&Path> {
        (!fs::is_remote(&self.folder)).then_some(self.folder.as_path())
    }

    fn name(&self, key: &EntryKey) -> PathBuf {
        self.path(key)
    }
}

const EXTENSION: &str = ".solved";

#[cfg(test)]
mod tests {
    use super::super::solutions::{look_up, store};
    use super::*;
    use orogen_grid::grid::{Grid, Window};
    use orogen_io::raster::Raster;
    use orogen_ops::op::Solution;

    struct Folder(PathBuf);

    impl Drop for Folder {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    fn folder_store(name: &str) -> (Folder, FolderStore) {
        let path = std::env::temp_dir().join(format!("orogen-cache-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        (Folder(path.clone()), FolderStore { slower_than: Duration::ZERO, ..FolderStore::new(path) })
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
        let (_folder, cache) = folder_store("kept");
        let kept = solution(600);
        assert!(look_up(&cache, &[1; 32], false).unwrap().is_none());
        store(&cache, &[1; 32], &kept).unwrap();
        for on_disk in [false, true] {
            let found = look_up(&cache, &[1; 32], on_disk).unwrap().unwrap();
            assert!(found.layers.iter().all(|layer| layer.is_on_disk() == on_disk));
            same(&kept, &found);
        }
        assert!(look_up(&cache, &[2; 32], false).unwrap().is_none());
        let numbers = Solution { layers: Vec::new(), scalars: vec![-7.0] };
        store(&cache, &[3; 32], &numbers).unwrap();
        same(&numbers, &look_up(&cache, &[3; 32], true).unwrap().unwrap());
    }

    #[test]
    fn damage_is_found_and_removed() {
        let (_folder, cache) = folder_store("damage");
        let key = [7; 32];
        let path = cache.path(&EntryKey::of(&key));
        store(&cache, &key, &solution(300)).unwrap();
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
                assert!(look_up(&cache, &key, on_disk).is_err());
                assert!(!path.exists(), "what is damaged is removed");
            }
        }
        store(&cache, &[8; 32], &solution(300)).unwrap();
        fs::rename(cache.path(&EntryKey::of(&[8; 32])), &path).unwrap();
        assert!(look_up(&cache, &key, false).is_err());
        store(&cache, &key, &solution(300)).unwrap();
        same(&solution(300), &look_up(&cache, &key, true).unwrap().unwrap());
    }

    #[test]
    fn the_longest_unused_goes_first() {
        let (_folder, mut cache) = folder_store("limit");
        let one = solution(256);
        cache.limit = 5 * Entry::new(&EntryKey::of(&[0; 32]), &one).length() / 2;
        let old = |key: u8, seconds: u64| {
            let file = File::options().append(true).open(cache.path(&EntryKey::of(&[key; 32]))).unwrap();
            file.set_modified(SystemTime::now() - Duration::from_secs(seconds)).unwrap();
        };
        let there = |key: u8| cache.path(&EntryKey::of(&[key; 32])).exists();
        store(&cache, &[1; 32], &one).unwrap();
        old(1, 30);
        store(&cache, &[2; 32], &one).unwrap();
        old(2, 20);
        assert!(look_up(&cache, &[1; 32], true).unwrap().is_some(), "used again");
        fs::write(cache.folder.join("mine.txt"), "not an entry").unwrap();
        let abandoned = cache.folder.join(".orogen-1-1-1.tmp");
        fs::write(&abandoned, [0; 99]).unwrap();
        store(&cache, &[3; 32], &one).unwrap();
        assert_eq!([there(1), there(2), there(3)], [true, false, true]);
        assert!(cache.folder.join("mine.txt").exists() && !abandoned.exists());
        store(&cache, &[4; 32], &solution(2000)).unwrap();
        assert_eq!([there(1), there(3), there(4)], [true, true, false], "what is larger than the limit is not kept");
    }

    #[test]
    fn many_at_once_neither_break_nor_see_halves() {
        let (_folder, cache) = folder_store("many");
        let kept = solution(300);
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| {
                    for round in 0..20 {
                        store(&cache, &[round % 3; 32], &kept).unwrap();
                        if let Some(found) = look_up(&cache, &[round % 3; 32], round % 2 == 0).unwrap() {
                            same(&kept, &found);
                        }
                        if round % 5 == 0 {
                            let _ = fs::remove_file(cache.path(&EntryKey::of(&[round % 3; 32])));
                        }
                    }
                });
            }
        });
    }
}
