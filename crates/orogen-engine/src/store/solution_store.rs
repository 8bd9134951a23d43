//! Stores, which keep solutions and tiles of levels for later runs as bytes under a key.

pub use super::entry_key::{EntryKey, NoEntryKey};
use super::level_tile::LevelTile;
use super::{entry, tile_entry};
use orogen_grid::grid::Grid;
use orogen_io::read_at::ReadAt;
use orogen_ops::op::Solution;
use std::fmt;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Keeps solutions, and optionally [tiles of levels](SolutionStore::keeps_tiles), for later runs and other sessions, as
/// bytes under a key. [`FolderStore`](super::folder::FolderStore) keeps them in a folder,
/// [`MemoryStore`](super::memory::MemoryStore) in memory. A program can implement other stores.
///
/// A [`Session`](crate::Session) looks up a solution before it solves, and stores it after solving. A store may drop
/// entries at any time and may be shared by any number of sessions and processes; its methods are called from several
/// threads at once.
///
/// A store cannot change terrain. Each entry contains its key and checksums of all its bytes, and a session verifies
/// them before it uses the entry: data that is not the solution is recognized as damaged. If an entry is missing or
/// damaged, or the store fails, the session solves instead; [`Session::store_failure`](crate::Session::store_failure)
/// returns the reason. To save memory, an entry may be read from the store while it is used. If that fails, the request
/// ends with an error.
///
/// ```
/// use orogen_engine::store::solution_store::{Entry, EntryKey, SolutionStore};
/// use orogen_engine::field::Fbm;
/// use orogen_engine::solver::Normalise;
/// use orogen_engine::{Options, Recipe, Session, Window, WorldSpec};
/// use orogen_io::read_at::ReadAt;
/// use std::collections::HashMap;
/// use std::io;
/// use std::sync::{Arc, Mutex, PoisonError};
///
/// /// Stands for an object store.
/// #[derive(Debug, Default)]
/// struct Objects(Mutex<HashMap<String, Arc<Vec<u8>>>>);
///
/// impl Objects {
///     fn all(&self) -> std::sync::MutexGuard<'_, HashMap<String, Arc<Vec<u8>>>> {
///         self.0.lock().unwrap_or_else(PoisonError::into_inner)
///     }
/// }
///
/// impl SolutionStore for Objects {
///     fn get(&self, key: &EntryKey) -> io::Result<Option<Box<dyn ReadAt>>> {
///         Ok(self.all().get(&key.to_string()).map(|bytes| Box::new(Arc::clone(bytes)) as Box<dyn ReadAt>))
///     }
///     fn put(&self, key: &EntryKey, entry: &Entry) -> io::Result<()> {
///         let bytes = Arc::new(entry.to_bytes()?);
///         self.all().insert(key.to_string(), bytes);
///         Ok(())
///     }
///     fn contains(&self, key: &EntryKey) -> bool {
///         self.all().contains_key(&key.to_string())
///     }
///     fn remove(&self, key: &EntryKey) -> io::Result<()> {
///         self.all().remove(&key.to_string());
///         Ok(())
///     }
/// }
///
/// let objects = Arc::new(Objects::default());
/// let mut recipe = Recipe::new(WorldSpec::default().with_size(Some([2000.0, 2000.0])).with_cell(20.0));
/// let land = Normalise { source: "noise".into(), low: 0.0, high: 900.0, ..Normalise::default() };
/// recipe.add("noise", Fbm::default()).add("land", land);
/// recipe.output("height", "land");
/// let make = || -> orogen_engine::Result<u64> {
///     let session = Session::new(Options { store: Some(objects.clone()), ..Options::default() })?;
///     session.open(recipe.clone())?.window("height", &Window::new(32, 32, 60.0))?;
///     Ok(session.solutions_made())
/// };
/// assert!(make()? > 0);
/// assert_eq!(make()?, 0, "another session finds what this one has solved");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait SolutionStore: Send + Sync + fmt::Debug {
    /// The bytes stored under `key`; `None` if there are none. The returned reader must stay valid even if the entry is
    /// removed or replaced meanwhile.
    ///
    /// # Errors
    /// If the store fails. The session then solves.
    fn get(&self, key: &EntryKey) -> io::Result<Option<Box<dyn ReadAt>>>;

    /// Stores an entry under `key`, atomically: a reader finds all of it or none of it. An existing entry is replaced.
    /// A store without enough space may ignore the entry.
    ///
    /// # Errors
    /// If the store fails. The session still keeps the solution in memory.
    fn put(&self, key: &EntryKey, entry: &Entry) -> io::Result<()>;

    /// Whether there is an entry under `key`, intact or not. It is called for estimates of work, so it should be fast.
    /// A store that does not know returns `false`.
    fn contains(&self, key: &EntryKey) -> bool;

    /// Removes a damaged entry. It is not an error if the entry does not exist.
    ///
    /// # Errors
    /// If the store fails.
    fn remove(&self, key: &EntryKey) -> io::Result<()>;

    /// Minimum estimated time on one core of solutions that are stored. By default it is 0, so all are stored. The
    /// tiles of levels of a request are stored if together they take about a tenth of this time or more.
    fn slower_than(&self) -> Duration {
        Duration::ZERO
    }

    /// Whether tiles of the levels of [levelled ops](orogen_ops::op::Levelled) are also stored. Default: `false`. A
    /// tile has a few hundred KiB and takes milliseconds to make, and a request looks up about ten tiles one after the
    /// other. A store that is slower than a disk should therefore not keep them.
    fn keeps_tiles(&self) -> bool {
        false
    }

    /// The folder for data that does not fit in memory, if the session's options do not name one. Default: `None`.
    fn scratch_folder(&self) -> Option<&Path> {
        None
    }

    /// The name of an entry in messages. Default: its key.
    fn name(&self, key: &EntryKey) -> PathBuf {
        PathBuf::from(key.to_string())
    }
}

/// A solution or a tile of a level to be stored: bytes that contain its key and checksums.
#[derive(Debug)]
pub struct Entry<'a> {
    key: &'a EntryKey,
    content: Content<'a>,
}

#[derive(Debug)]
enum Content<'a> {
    Solution(&'a Solution),
    Tile(&'a LevelTile, &'a [Grid]),
}

impl<'a> Entry<'a> {
    pub(crate) fn new(key: &'a EntryKey, solution: &'a Solution) -> Entry<'a> {
        Entry { key, content: Content::Solution(solution) }
    }

    pub(crate) fn of_tile(key: &'a EntryKey, tile: &'a LevelTile, planes: &'a [Grid]) -> Entry<'a> {
        Entry { key, content: Content::Tile(tile, planes) }
    }

    /// Whether it is a tile of a level. There are many tiles, and each can be made again in milliseconds.
    #[must_use]
    pub fn is_tile(&self) -> bool {
        matches!(self.content, Content::Tile(..))
    }

    /// Its length in bytes.
    #[must_use]
    pub fn length(&self) -> u64 {
        match self.content {
            Content::Solution(solution) => entry::length(solution),
            Content::Tile(tile, _) => tile_entry::length(tile),
        }
    }

    /// Writes its bytes: a solution in pages of 256 KiB, a tile at once.
    ///
    /// # Errors
    /// If `out` fails, or a solution on disk cannot be read.
    pub fn write_to(&self, out: &mut dyn Write) -> io::Result<()> {
        match self.content {
            Content::Solution(solution) => entry::write(out, &self.key.0, solution),
            Content::Tile(tile, planes) => tile_entry::write(out, self.key, tile, planes),
        }
    }

    /// All of its bytes.
    ///
    /// # Errors
    /// If a solution on disk cannot be read.
    pub fn to_bytes(&self) -> io::Result<Vec<u8>> {
        let mut bytes = Vec::with_capacity(usize::try_from(self.length()).unwrap_or_default());
        self.write_to(&mut bytes)?;
        Ok(bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_read_back_from_what_they_display() {
        let key = EntryKey::of(&[7; 32]);
        let text = key.to_string();
        assert_eq!((text.len(), text.parse()), (64, Ok(key)));
        assert_ne!(key, EntryKey::of(&[8; 32]));
        for wrong in ["", &text[1..], &format!("{text}0"), &text.replacen(&text[..1], "g", 1), &"é".repeat(32)] {
            assert_eq!(wrong.parse::<EntryKey>(), Err(NoEntryKey), "{wrong}");
        }
    }
}
