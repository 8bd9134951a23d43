//! Stores: where solutions and tiles of levels wait for later runs, as bytes under a key.

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

/// Keeps solutions, and tiles of levels if it [wants](SolutionStore::keeps_tiles), for later runs and other sessions:
/// bytes under a key. [`FolderStore`](super::folder::FolderStore) keeps them in a folder,
/// [`MemoryStore`](super::memory::MemoryStore) in memory; a program may keep them anywhere else.
///
/// A [`Session`](crate::Session) looks for a solution before it solves, and stores one after it has solved. A store may
/// forget entries at any time and may be shared by any number of sessions and processes; its methods are called from
/// several threads at once.
///
/// A store cannot change terrain. Each entry contains its key and checksums of all its bytes, and a session verifies
/// them before it uses the entry, so whatever a store returns is either the solution or recognised as damaged. If an
/// entry is missing or damaged or the store fails, the session solves instead;
/// [`Session::store_failure`](crate::Session::store_failure) tells why. If an entry is left in the store to save memory
/// and can no longer be read while it is used, the request ends with an error.
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
    /// The bytes stored under `key`; `None` if there are none. They must stay readable while they are held, even if the
    /// entry is removed or replaced meanwhile.
    ///
    /// # Errors
    /// If the store fails. The session then solves.
    fn get(&self, key: &EntryKey) -> io::Result<Option<Box<dyn ReadAt>>>;

    /// Stores an entry under `key`, atomically: a reader finds all of it or none of it. An entry that is there already
    /// is replaced. A store that has no room for it may ignore it.
    ///
    /// # Errors
    /// If the store fails. The session keeps the solution in memory all the same.
    fn put(&self, key: &EntryKey, entry: &Entry) -> io::Result<()>;

    /// Whether there is an entry under `key`, intact or not. It is asked for estimates of work, so it should be quick;
    /// a store that cannot tell returns `false`.
    fn contains(&self, key: &EntryKey) -> bool;

    /// Removes a damaged entry. It is no error if there is none.
    ///
    /// # Errors
    /// If the store fails.
    fn remove(&self, key: &EntryKey) -> io::Result<()>;

    /// Solutions whose estimated time on one core is less are not stored. By default all are stored. Tiles of levels
    /// are stored if those of a request take about a tenth of this time or more.
    fn slower_than(&self) -> Duration {
        Duration::ZERO
    }

    /// Whether tiles of the levels of [levelled ops](orogen_ops::op::Levelled) are stored, too. A tile has some hundred
    /// KiB and takes milliseconds to make, and a request looks for some ten of them, one after the other: a store that
    /// is slower than a disk should not keep them. By default it does not.
    fn keeps_tiles(&self) -> bool {
        false
    }

    /// The folder for data that does not fit in memory, if the session's options name none. By default there is none.
    fn scratch_folder(&self) -> Option<&Path> {
        None
    }

    /// The name of an entry in messages: by default its key.
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

    /// Whether it is a tile of a level: there are many of them, and each is made again in milliseconds.
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

    /// Writes its bytes: those of a solution a page of 256 KiB at a time, those of a tile at once.
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
