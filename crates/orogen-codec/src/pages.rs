//! A grid in a file, in square pages with checksums. The most recently read pages are kept in memory.

use crate::read_at::{PositionedFile, ReadAt};
use crate::temporary::Temporary;
use crate::{fs, samples};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use std::collections::HashMap;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Side of a page, in samples.
pub const SIDE: usize = 256;

/// Size of a page in the file, in bytes.
pub const BYTES: usize = SIDE * SIDE * 4;

/// Maximum number of pages kept in memory.
const MAX_KEPT: usize = 16;

/// Memory needed for a grid in a file, in bytes.
#[must_use]
pub fn memory(window: &Window) -> u64 {
    (count(window).min(MAX_KEPT) * BYTES + count(window) * size_of::<Option<u32>>()) as u64
}

/// Size of the file of a grid over a window, in bytes.
#[must_use]
pub fn disk(window: &Window) -> u64 {
    (count(window) as u64).saturating_mul(BYTES as u64)
}

/// Number of pages of a grid over a window.
#[must_use]
pub fn count(window: &Window) -> usize {
    window.width.div_ceil(SIDE).saturating_mul(window.height.div_ceil(SIDE))
}

/// The checksum of a page.
#[must_use]
pub fn checksum(bytes: &[u8]) -> u32 {
    crc32fast::hash(bytes)
}

/// Whether bytes have the checksum `sum`.
#[must_use]
pub fn has_checksum(bytes: &[u8], sum: u32) -> bool {
    checksum(bytes) == sum
}

/// A file of pages, which several grids can share. Any number of threads can read it at the same time.
#[derive(Debug)]
pub struct PageFile {
    bytes: Bytes,
    /// The file name in messages.
    path: PathBuf,
    /// The temporary file name, if it could not be removed at once.
    _name: Option<Temporary>,
}

#[derive(Debug)]
enum Bytes {
    Scratch(PositionedFile),
    Stored(Box<dyn ReadAt>),
}

impl PageFile {
    /// A new file in `folder`, which is created if needed. The file is removed on drop, or when the program ends for
    /// any reason.
    ///
    /// # Errors
    /// If the file cannot be created.
    pub fn scratch(folder: &Path) -> Result<PageFile> {
        let made = fs::create_dir_all(folder).and_then(|()| Temporary::create(folder));
        let (name, file) = made.map_err(|cause| Error::file("work in", folder, &cause))?;
        let bytes = Bytes::Scratch(PositionedFile::new(file));
        Ok(PageFile { bytes, path: folder.to_path_buf(), _name: name.unlink() })
    }

    /// Bytes that are already stored, with the file name for messages. They are read-only.
    #[must_use]
    pub fn stored(bytes: Box<dyn ReadAt>, name: &Path) -> PageFile {
        PageFile { bytes: Bytes::Stored(bytes), path: name.to_path_buf(), _name: None }
    }

    /// Reads bytes at an offset.
    pub fn read(&self, at: u64, bytes: &mut [u8]) -> io::Result<()> {
        match &self.bytes {
            Bytes::Scratch(file) => file.read_exact_at(at, bytes),
            Bytes::Stored(stored) => stored.read_exact_at(at, bytes),
        }
    }

    fn write(&self, at: u64, bytes: &[u8]) -> io::Result<()> {
        match &self.bytes {
            Bytes::Scratch(file) => file.write_all_at(at, bytes),
            Bytes::Stored(_) => Err(io::ErrorKind::ReadOnlyFilesystem.into()),
        }
    }
}

/// A grid in a file.
#[derive(Debug)]
pub struct Pages {
    window: Window,
    file: Arc<PageFile>,
    /// Offset of the first page in the file.
    base: u64,
    /// The checksum of each page that was written. Pages without one are zeros.
    sums: Vec<Option<u32>>,
    kept: Mutex<Kept>,
}

type Page = Arc<Vec<f32>>;

/// The most recently read pages, each with the time of its last use.
#[derive(Debug, Default)]
struct Kept {
    pages: HashMap<usize, (u64, Page)>,
    turn: u64,
}

impl Pages {
    /// A grid of zeros in a new file in `folder`.
    ///
    /// # Errors
    /// If the file cannot be created.
    pub fn scratch(folder: &Path, window: Window) -> Result<Pages> {
        Ok(Pages::within(Arc::new(PageFile::scratch(folder)?), 0, vec![None; count(&window)], window))
    }

    /// A grid whose pages are in a file from offset `base` on. `sums` has their checksums.
    #[must_use]
    pub fn within(file: Arc<PageFile>, base: u64, sums: Vec<Option<u32>>, window: Window) -> Pages {
        Pages { window, file, base, sums, kept: Mutex::default() }
    }

    /// The window of the samples.
    pub fn window(&self) -> &Window {
        &self.window
    }

    /// The samples of page `index`, with [`SIDE`] per row, and zeros outside the window.
    ///
    /// # Errors
    /// If the page cannot be read, or does not match its checksum.
    pub fn page(&self, index: usize) -> Result<Page> {
        {
            let mut kept = lock(&self.kept);
            kept.turn += 1;
            let turn = kept.turn;
            if let Some((read, page)) = kept.pages.get_mut(&index) {
                *read = turn;
                return Ok(Arc::clone(page));
            }
        }
        let page = Arc::new(self.load(index)?);
        self.keep(index, &page);
        Ok(page)
    }

    fn load(&self, index: usize) -> Result<Vec<f32>> {
        let Some(sum) = self.sums.get(index).copied().flatten() else { return Ok(vec![0.0; SIDE * SIDE]) };
        let mut bytes = vec![0; BYTES];
        let read = self.file.read(self.base + (index * BYTES) as u64, &mut bytes);
        read.map_err(|cause| Error::file("read the spilled data in", &self.file.path, &cause))?;
        if !has_checksum(&bytes, sum) {
            let path = self.file.path.display();
            let message = format!("the spilled data in {path} are damaged; start again");
            return Err(Error::new(ErrorKind::File, message));
        }
        Ok(samples::from_bytes(&bytes))
    }

    fn keep(&self, index: usize, page: &Page) {
        let mut kept = lock(&self.kept);
        let turn = kept.turn;
        kept.pages.insert(index, (turn, Arc::clone(page)));
        while kept.pages.len() > MAX_KEPT {
            let oldest = kept.pages.iter().min_by_key(|(index, (read, _))| (*read, **index)).map(|(index, _)| *index);
            match oldest {
                Some(oldest) => kept.pages.remove(&oldest),
                None => return,
            };
        }
    }

    /// Writes the part of `part` that overlaps the grid.
    ///
    /// # Errors
    /// If the disk is full or fails, or if a partially overwritten page cannot be read.
    pub fn put(&mut self, part: &Grid) -> Result<()> {
        for (index, window) in self.touched(part.window()) {
            let whole = part.window().contains(&self.valid(&window));
            let before = if whole { vec![0.0; SIDE * SIDE] } else { self.page(index)?.to_vec() };
            let Some(mut page) = Grid::from_data(window, before) else { continue };
            match part.crop(&self.valid(&window)) {
                Some(inside) => page.paste(&inside),
                None => page.paste(part),
            }
            let samples = page.into_data();
            let bytes = samples::to_bytes(&samples);
            let written = self.file.write(self.base + (index * BYTES) as u64, &bytes);
            written.map_err(|cause| Error::file("spill more data to", &self.file.path, &cause))?;
            self.sums[index] = Some(checksum(&bytes));
            self.keep(index, &Arc::new(samples));
        }
        Ok(())
    }

    /// The samples of a window, which must be inside the window of the grid.
    ///
    /// # Errors
    /// If a page cannot be read.
    pub fn get(&self, window: &Window) -> Result<Grid> {
        let mut grid = Grid::filled(*window, 0.0f32);
        for (index, page) in self.touched(window) {
            let samples = self.page(index)?;
            let (left, top) = (page.x.max(window.x), page.y.max(window.y));
            let width = (page.right().min(window.right()) - left) as usize;
            for y in top..page.bottom().min(window.bottom()) {
                let from = (y - page.y) as usize * SIDE + (left - page.x) as usize;
                let to = (left - window.x) as usize;
                grid.row_mut((y - window.y) as usize)[to..to + width].copy_from_slice(&samples[from..from + width]);
            }
        }
        Ok(grid)
    }

    /// The pages that overlap a window, each with its own window.
    fn touched(&self, window: &Window) -> Vec<(usize, Window)> {
        let whole = self.window;
        let columns = whole.width.div_ceil(SIDE);
        let along = |start: i64, end: i64, whole_start: i64, whole_end: i64| {
            let (start, end) = (start.max(whole_start), end.min(whole_end));
            let page = |at: i64| (at - whole_start) as usize / SIDE;
            if start < end { page(start)..page(end - 1) + 1 } else { 0..0 }
        };
        let rows = along(window.y, window.bottom(), whole.y, whole.bottom());
        let across = along(window.x, window.right(), whole.x, whole.right());
        let page = |row: usize, column: usize| {
            let (x, y) = (whole.x + (column * SIDE) as i64, whole.y + (row * SIDE) as i64);
            (row * columns + column, Window { x, y, width: SIDE, height: SIDE, cell: whole.cell })
        };
        rows.flat_map(|row| across.clone().map(move |column| page(row, column))).collect()
    }

    /// The part of a page inside the window.
    fn valid(&self, page: &Window) -> Window {
        Window {
            width: (self.window.right().min(page.right()) - page.x) as usize,
            height: (self.window.bottom().min(page.bottom()) - page.y) as usize,
            ..*page
        }
    }
}

/// Ignores poisoning: the data is consistent even if a thread panicked while it held the lock.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
