//! A grid in a file, in square pages, each with a checksum, the last read kept in memory.

use crate::file::Temporary;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use std::collections::HashMap;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Samples along a page's side.
pub const SIDE: usize = 256;

/// Bytes of a page in the file.
pub const BYTES: usize = SIDE * SIDE * 4;

/// Most pages kept in memory.
const MAX_KEPT: usize = 16;

/// Bytes of memory that a grid in a file takes.
pub fn memory(window: &Window) -> u64 {
    (count(window).min(MAX_KEPT) * BYTES + count(window) * size_of::<Option<u32>>()) as u64
}

/// Bytes that a grid over a window takes in a file.
pub fn disk(window: &Window) -> u64 {
    (count(window) as u64).saturating_mul(BYTES as u64)
}

/// How many pages a grid over a window has.
pub fn count(window: &Window) -> usize {
    window.width.div_ceil(SIDE).saturating_mul(window.height.div_ceil(SIDE))
}

/// The checksum of a page.
pub fn checksum(bytes: &[u8]) -> u32 {
    crc32fast::hash(bytes)
}

/// A file that pages are in: several grids may share one.
#[derive(Debug)]
pub struct PageFile {
    file: Mutex<File>,
    /// What it is called in a message.
    path: PathBuf,
    /// Its name, where it could not be taken away at once.
    _name: Option<Temporary>,
}

impl PageFile {
    /// A new file in `folder`, which is made if it is not there. The file is gone when it is dropped, or when the program ends,
    /// however it does.
    ///
    /// # Errors
    /// If none can be made there.
    pub fn scratch(folder: &Path) -> Result<PageFile> {
        let made = std::fs::create_dir_all(folder).and_then(|()| Temporary::create(folder));
        let (name, file) = made.map_err(|cause| Error::file("work in", folder, &cause))?;
        Ok(PageFile { file: Mutex::new(file), path: folder.to_path_buf(), _name: name.unlink() })
    }

    /// An open file.
    pub fn open(file: File, path: &Path) -> PageFile {
        PageFile { file: Mutex::new(file), path: path.to_path_buf(), _name: None }
    }

    /// Reads bytes at a place.
    pub fn read(&self, at: u64, bytes: &mut [u8]) -> io::Result<()> {
        let mut file = lock(&self.file);
        file.seek(SeekFrom::Start(at))?;
        file.read_exact(bytes)
    }

    fn write(&self, at: u64, bytes: &[u8]) -> io::Result<()> {
        let mut file = lock(&self.file);
        file.seek(SeekFrom::Start(at))?;
        file.write_all(bytes)
    }
}

/// A grid in a file.
#[derive(Debug)]
pub struct Pages {
    window: Window,
    file: Arc<PageFile>,
    /// Where its first page is in the file.
    base: u64,
    /// The checksum of each page that was written; the others are zeros.
    sums: Vec<Option<u32>>,
    kept: Mutex<Kept>,
}

type Page = Arc<Vec<f32>>;

/// The pages last read, each with the turn it was read at.
#[derive(Debug, Default)]
struct Kept {
    pages: HashMap<usize, (u64, Page)>,
    turn: u64,
}

impl Pages {
    /// A grid of zeros in a file of its own in `folder`.
    ///
    /// # Errors
    /// If no file can be made there.
    pub fn scratch(folder: &Path, window: Window) -> Result<Pages> {
        Ok(Pages::within(Arc::new(PageFile::scratch(folder)?), 0, vec![None; count(&window)], window))
    }

    /// A grid whose pages are in a file from `base` on, with their checksums.
    pub fn within(file: Arc<PageFile>, base: u64, sums: Vec<Option<u32>>, window: Window) -> Pages {
        Pages { window, file, base, sums, kept: Mutex::default() }
    }

    /// Where the samples stand.
    pub fn window(&self) -> &Window {
        &self.window
    }

    /// The samples of page `index`, [`SIDE`] a row, zero beyond the window.
    ///
    /// # Errors
    /// If it cannot be read, or is not what was written.
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
        if checksum(&bytes) != sum {
            let path = self.file.path.display();
            let message = format!("the spilled data in {path} are damaged; start again");
            return Err(Error::new(ErrorKind::File, message));
        }
        Ok(bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect())
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

    /// Writes what of `part` lies in the window.
    ///
    /// # Errors
    /// If the disk takes no more, or a page that is written in part cannot be read.
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
            let bytes: Vec<u8> = samples.iter().flat_map(|sample| sample.to_le_bytes()).collect();
            let written = self.file.write(self.base + (index * BYTES) as u64, &bytes);
            written.map_err(|cause| Error::file("spill more data to", &self.file.path, &cause))?;
            self.sums[index] = Some(checksum(&bytes));
            self.keep(index, &Arc::new(samples));
        }
        Ok(())
    }

    /// The samples of a window that lies in this one.
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

    /// The pages that share samples with a window, with their own windows.
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

    /// What of a page lies in the window.
    fn valid(&self, page: &Window) -> Window {
        Window {
            width: (self.window.right().min(page.right()) - page.x) as usize,
            height: (self.window.bottom().min(page.bottom()) - page.y) as usize,
            ..*page
        }
    }
}

/// A lock whose holder panicked still guards sound data.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
