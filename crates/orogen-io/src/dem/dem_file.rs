//! Files of heights from which windows are read when they are requested.

use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock, PoisonError, Weak};
use std::time::SystemTime;

use sha2::{Digest, Sha256};

use super::part::Outline;
use super::prepared::PreparedDem;
use crate::format::dem::{Request, refused};
use crate::format::sidecar::Sidecar;
use crate::{fs, open};
use orogen_grid::error::{Error, Result};
use orogen_grid::grid::Window;

/// Maximum memory of heights that are read whole, in bytes: of a file, and of an object of a store.
const SMALL: u64 = 16 << 20;
const SMALL_OBJECT: u64 = 1 << 20;

/// Length of the start and of the end of a file that its identity contains, in bytes. One of them has the directory of
/// a GeoTIFF, and with it the lengths of all blocks.
const ENDS: u64 = 64 << 10;

/// A large file of heights. Only its size and position are read when it is opened. Requests read the windows that they
/// need, with the same bits as from the whole file, and keep them as long as they run. Once a request needs all
/// heights, they are kept for all later requests.
#[derive(Debug)]
pub struct DemFile {
    path: PathBuf,
    band: Option<u32>,
    outline: Outline,
    /// The place without its heights. Its hash is the identity of the file instead of that of the heights.
    place: Arc<PreparedDem>,
    state: State,
    whole: OnceLock<Arc<PreparedDem>>,
    /// Held while all heights are read, so that they are read once.
    reading: Mutex<()>,
    /// The windows that running requests hold.
    windows: Mutex<Vec<Weak<PreparedDem>>>,
}

/// Length and time of the last change of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct State {
    length: u64,
    changed: Option<SystemTime>,
}

impl State {
    fn of(path: &Path) -> Result<State> {
        let there = fs::metadata(path).map_err(|cause| Error::file("read", path, &cause))?;
        Ok(State { length: there.len(), changed: there.modified().ok() })
    }
}

impl DemFile {
    /// Opens a file. `None` if it cannot be read in parts, or is so small that it is read whole: up to 16 MiB (1 MiB of
    /// an object store), and up to half of `allowed` bytes.
    ///
    /// # Errors
    /// If the file cannot be read, or the distance between its samples is out of range.
    pub fn open(path: &Path, band: Option<u32>, allowed: u64) -> Result<Option<DemFile>> {
        let Some(outline) = Outline::read(path, band)? else { return Ok(None) };
        let small = if fs::is_remote(path) { SMALL_OBJECT } else { SMALL };
        if outline.whole_memory() <= small.min(allowed / 2) {
            return Ok(None);
        }
        let (file, own) = super::open::split(path);
        let state = State::of(&file)?;
        let mut place = outline.empty();
        place.notes.extend(outline.note());
        place.hash = identity(&file, own.or(band), &state)?;
        Ok(Some(DemFile {
            path: path.to_path_buf(),
            band,
            outline,
            place: Arc::new(place),
            state,
            whole: OnceLock::new(),
            reading: Mutex::default(),
            windows: Mutex::default(),
        }))
    }

    /// The size and position, without heights.
    pub fn place(&self) -> &Arc<PreparedDem> {
        &self.place
    }

    /// Memory of the heights that are kept for later requests, in bytes.
    pub fn kept(&self) -> u64 {
        self.whole.get().map_or(0, |whole| whole.memory())
    }

    /// Memory of all heights, in bytes.
    pub fn whole_memory(&self) -> u64 {
        self.outline.whole_memory()
    }

    /// Memory for reading the heights in a window, or all heights, in bytes; without those that are kept. Around large
    /// holes more is needed.
    pub fn memory(&self, window: Option<&Window>) -> u64 {
        match (self.whole.get(), window) {
            (Some(_), _) => 0,
            (None, Some(window)) => self.outline.memory(window),
            (None, None) => self.outline.whole_memory(),
        }
    }

    /// The heights in a window on the lattice of the file, or all heights, which are then kept. Other users of the
    /// window find it by [`DemFile::covering`] as long as the caller holds it.
    ///
    /// # Errors
    /// If the file was changed since it was opened, cannot be read, or needs more than `allowed` bytes.
    pub fn read(&self, window: Option<&Window>, allowed: u64) -> Result<Arc<PreparedDem>> {
        let request = Request::new(allowed).with_band(self.band);
        if let Some(window) = window {
            if let Some(held) = self.covering(window) {
                return Ok(held);
            }
            self.check()?;
            // Holes that are filled from a large part of the file are filled once for all later requests.
            let whole = self.outline.whole_memory();
            let most = if whole <= allowed { whole / 4 } else { u64::MAX };
            if let Some(part) = self.outline.part(&self.path, window, request, most)? {
                let part = Arc::new(part);
                let mut windows = self.windows.lock().unwrap_or_else(PoisonError::into_inner);
                windows.retain(|held| held.strong_count() > 0);
                windows.push(Arc::downgrade(&part));
                return Ok(part);
            }
        }
        let _alone = self.reading.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(whole) = self.whole.get() {
            return Ok(Arc::clone(whole));
        }
        self.check()?;
        let whole = Arc::new(PreparedDem::read(&self.path, None, request)?);
        Ok(Arc::clone(self.whole.get_or_init(|| whole)))
    }

    /// The heights that cover a window, if a running request holds them or they are kept.
    pub fn covering(&self, window: &Window) -> Option<Arc<PreparedDem>> {
        if let Some(whole) = self.whole.get() {
            return Some(Arc::clone(whole));
        }
        let windows = self.windows.lock().unwrap_or_else(PoisonError::into_inner);
        windows.iter().filter_map(Weak::upgrade).find(|held| held.grid.window().contains(window))
    }

    /// Rejects a file that was changed since it was opened: its windows would not fit together.
    fn check(&self) -> Result<()> {
        match State::of(&super::open::split(&self.path).0)? == self.state {
            true => Ok(()),
            false => {
                Err(refused(&self.path.display().to_string(), "it was changed since it was opened; open it again"))
            }
        }
    }
}

/// The identity of a file, from which no heights are read: its path, band, length, time of change, both ends, and the
/// content of its sidecars.
fn identity(path: &Path, band: Option<u32>, state: &State) -> Result<[u8; 32]> {
    let failed = |cause: std::io::Error| Error::file("read", path, &cause);
    let mut digest = Sha256::new();
    let real = fs::canonicalize(path).map_err(failed)?;
    let sidecar = Sidecar::beside(path)?;
    let mask = sidecar.as_ref().and_then(|sidecar| sidecar.mask.as_deref()).map(State::of).transpose()?;
    digest.update(format!("{real:?} {band:?} {state:?} {sidecar:?} {mask:?} "));
    let mut file = open::regular(path, "read")?;
    for start in [0, state.length.saturating_sub(ENDS)] {
        let mut bytes = Vec::new();
        file.seek(SeekFrom::Start(start)).map_err(failed)?;
        (&mut file).take(ENDS).read_to_end(&mut bytes).map_err(failed)?;
        digest.update(&bytes);
    }
    Ok(digest.finalize().into())
}
