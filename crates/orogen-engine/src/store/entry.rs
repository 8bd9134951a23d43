//! The file format of a solution.
//!
//! A header (magic, key, numbers, the windows of the layers, a checksum), the layers' pages in sequence, the checksum
//! of each page, and a checksum of those. Numbers are little-endian. The length follows from the header, so that a
//! truncated file is detected at once.

use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_io::pages::{self, BYTES, PageFile, Pages, SIDE, checksum, has_checksum};
use orogen_io::raster::Raster;
use orogen_io::read_at::ReadAt;
use orogen_io::samples;
use orogen_ops::op::Solution;
use std::io::{self, Write};
use std::path::Path;
use std::sync::Arc;

/// The magic of every file. Its number changes with the layout.
const MAGIC: &[u8; 16] = b"orogen solved 1\n";

/// Maximum number of layers and of numbers. No solver makes as many; a larger count means damage.
const MOST: usize = 1 << 20;

/// Size of a stored solution, in bytes.
pub fn length(solution: &Solution) -> u64 {
    let head = 64 + 8 * solution.scalars.len() + 40 * solution.layers.len() + 4;
    let pages: u64 = solution.layers.iter().map(|layer| pages::count(layer.window()) as u64).sum();
    head as u64 + pages * (BYTES as u64 + 4) + 4
}

/// Writes a solution.
pub fn write(out: &mut dyn Write, key: &[u8; 32], solution: &Solution) -> io::Result<()> {
    let mut head = Vec::new();
    head.extend_from_slice(MAGIC);
    head.extend_from_slice(key);
    for count in [solution.scalars.len(), solution.layers.len()] {
        head.extend_from_slice(&(count as u64).to_le_bytes());
    }
    for scalar in &solution.scalars {
        head.extend_from_slice(&scalar.to_bits().to_le_bytes());
    }
    for layer in &solution.layers {
        let window = layer.window();
        for number in
            [window.x as u64, window.y as u64, window.width as u64, window.height as u64, window.cell.to_bits()]
        {
            head.extend_from_slice(&number.to_le_bytes());
        }
    }
    let sum = checksum(&head);
    out.write_all(&head)?;
    out.write_all(&sum.to_le_bytes())?;
    let mut sums = Vec::new();
    for layer in &solution.layers {
        for window in layer.window().tiles(SIDE) {
            let part = layer.get(&window)?;
            let mut bytes = vec![0; BYTES];
            for row in 0..window.height {
                samples::write_bytes(&mut bytes[row * SIDE * 4..], part.row(row));
            }
            sums.extend_from_slice(&checksum(&bytes).to_le_bytes());
            out.write_all(&bytes)?;
        }
    }
    out.write_all(&sums)?;
    out.write_all(&checksum(&sums).to_le_bytes())
}

/// Reads the bytes that [`write`] wrote, into memory or leaving them in the store. All bytes are verified first.
///
/// # Errors
/// If the bytes cannot be read, are incomplete or damaged, or contain another solution.
pub fn read(bytes: Box<dyn ReadAt>, path: &Path, key: &[u8; 32], on_disk: bool) -> Result<Solution> {
    let length = bytes.length().map_err(|cause| Error::file("read", path, &cause))?;
    let mut reader = Reader { file: Arc::new(PageFile::stored(bytes, path)), path, at: 0 };
    let head = reader.head(key, length)?;
    let mut base = reader.at;
    let pages: usize = head.windows.iter().map(pages::count).sum();
    let sums = reader.sums(base + pages as u64 * BYTES as u64, pages)?;
    let mut layers = Vec::new();
    let mut sums = sums.into_iter();
    for window in head.windows {
        let sums: Vec<Option<u32>> = sums.by_ref().take(pages::count(&window)).map(Some).collect();
        let paged = Pages::within(Arc::clone(&reader.file), base, sums, window);
        // One pass over the whole file in either case: damage is found before the work begins.
        let mut grid = (!on_disk).then(|| Grid::filled(window, 0.0f32));
        for part in window.tiles(SIDE) {
            let part = paged.get(&part)?;
            if let Some(grid) = &mut grid {
                grid.paste(&part);
            }
        }
        base += pages::disk(&window);
        layers.push(grid.map_or_else(|| Raster::on_disk(paged), Raster::in_memory));
    }
    Ok(Solution { layers, scalars: head.scalars })
}

/// The windows of a solution's layers, from its header.
///
/// # Errors
/// If the header cannot be read, is damaged, or belongs to another solution.
pub fn windows(bytes: Box<dyn ReadAt>, path: &Path, key: &[u8; 32]) -> Result<Vec<Window>> {
    let length = bytes.length().map_err(|cause| Error::file("read", path, &cause))?;
    let mut reader = Reader { file: Arc::new(PageFile::stored(bytes, path)), path, at: 0 };
    Ok(reader.head(key, length)?.windows)
}

struct Head {
    scalars: Vec<f64>,
    windows: Vec<Window>,
}

struct Reader<'a> {
    file: Arc<PageFile>,
    path: &'a Path,
    at: u64,
}

impl Reader<'_> {
    fn fault(&self, why: &str) -> Error {
        Error::new(ErrorKind::File, format!("{} is not a stored solution: {why}", self.path.display()))
    }

    fn bytes(&mut self, count: usize) -> Result<Vec<u8>> {
        let mut bytes = vec![0; count];
        self.file.read(self.at, &mut bytes).map_err(|cause| Error::file("read", self.path, &cause))?;
        self.at += count as u64;
        Ok(bytes)
    }

    fn sum(&mut self) -> Result<u32> {
        let bytes = self.bytes(4)?;
        Ok(u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]))
    }

    fn head(&mut self, key: &[u8; 32], length: u64) -> Result<Head> {
        let mut bytes = self.bytes(MAGIC.len() + 32 + 16)?;
        if bytes[..16] != MAGIC[..] || bytes[16..48] != key[..] {
            return Err(self.fault("it is not a solution of this version (bad magic number)"));
        }
        let [scalars, layers] = [48, 56].map(|at| usize::try_from(word(&bytes, at)).unwrap_or(usize::MAX));
        if scalars > MOST || layers > MOST {
            return Err(self.fault("it declares too many layers"));
        }
        bytes.extend(self.bytes(scalars * 8 + layers * 40)?);
        let sum = self.sum()?;
        if !has_checksum(&bytes, sum) {
            return Err(self.fault("its header is damaged"));
        }
        let numbers = |from: usize, count: usize| (0..count).map(move |i| from + i * 8);
        let scalars_at = 64;
        let windows_at = scalars_at + scalars * 8;
        let window = |at: usize| Window {
            x: word(&bytes, at) as i64,
            y: word(&bytes, at + 8) as i64,
            width: word(&bytes, at + 16) as usize,
            height: word(&bytes, at + 24) as usize,
            cell: f64::from_bits(word(&bytes, at + 32)),
        };
        let head = Head {
            scalars: numbers(scalars_at, scalars).map(|at| f64::from_bits(word(&bytes, at))).collect(),
            windows: (0..layers).map(|i| window(windows_at + i * 40)).collect(),
        };
        if !head.windows.iter().all(is_layer) {
            return Err(self.fault("a layer has no valid position, size or cell"));
        }
        let pages = head.windows.iter().fold(0u64, |sum, window| sum.saturating_add(pages::count(window) as u64));
        let whole = pages.saturating_mul(BYTES as u64 + 4).saturating_add(self.at + 4);
        if length != whole {
            return Err(self.fault(&format!("it has {length} bytes instead of {whole}")));
        }
        Ok(head)
    }

    fn sums(&mut self, at: u64, pages: usize) -> Result<Vec<u32>> {
        self.at = at;
        let bytes = self.bytes(pages * 4)?;
        let sum = self.sum()?;
        if !has_checksum(&bytes, sum) {
            return Err(self.fault("its checksums are damaged"));
        }
        Ok(bytes.chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect())
    }
}

/// Whether a solver can make a layer over this window.
fn is_layer(window: &Window) -> bool {
    const FAR: i64 = 1 << 53;
    let is_side = |side: usize| (1..=FAR as u64).contains(&(side as u64));
    let is_position = |position: i64| (-FAR..=FAR).contains(&position);
    is_side(window.width)
        && is_side(window.height)
        && is_position(window.x)
        && is_position(window.y)
        && window.cell.is_finite()
        && window.cell > 0.0
}

/// Eight bytes as an integer; missing bytes give 0.
fn word(bytes: &[u8], at: usize) -> u64 {
    let mut word = [0; 8];
    if let Some(there) = bytes.get(at..at + 8) {
        word.copy_from_slice(there);
    }
    u64::from_le_bytes(word)
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_grid::grid::Grid;
    use orogen_io::read_at::PositionedFile;

    /// A header with a valid checksum that no solver writes: an empty window, however high, has no pages.
    #[test]
    fn layers_that_no_solver_makes_are_refused() {
        let key = [7; 32];
        let sound = Window::new(3, 2, 10.0);
        let layer = Raster::in_memory(Grid::filled(sound, 1.0f32));
        let mut bytes = Vec::new();
        write(&mut bytes, &key, &Solution { layers: vec![layer], scalars: Vec::new() }).unwrap();
        let path = std::env::temp_dir().join(format!("orogen-entry-{}", std::process::id()));
        let read_with = |window: [u64; 5], pages: usize| {
            let mut bytes = bytes.clone();
            bytes.truncate(104 + 4 + pages * BYTES);
            for (k, number) in window.iter().enumerate() {
                bytes[64 + 8 * k..72 + 8 * k].copy_from_slice(&number.to_le_bytes());
            }
            let sum = checksum(&bytes[..104]).to_le_bytes();
            bytes[104..108].copy_from_slice(&sum);
            let sums: Vec<u8> = bytes[108..].chunks(BYTES).flat_map(|page| checksum(page).to_le_bytes()).collect();
            let sums_of_sums = checksum(&sums).to_le_bytes();
            bytes.extend([&sums[..], &sums_of_sums].concat());
            std::fs::write(&path, &bytes).unwrap();
            let open = || Box::new(PositionedFile::new(std::fs::File::open(&path).unwrap()));
            let headed = windows(open(), &path, &key);
            let read = read(open(), &path, &key, false);
            assert_eq!(headed.is_ok(), read.is_ok());
            read.map(|_| ()).map_err(|error| error.to_string())
        };
        let cell = 10.0f64.to_bits();
        assert_eq!(read_with([0, 0, 3, 2, cell], 1), Ok(()));
        let far = (1u64 << 53) + 1;
        for (window, pages) in [
            ([0, 0, 0, 1 << 62, cell], 0),
            ([0, 0, u64::MAX, 0, cell], 0),
            ([far, 0, 3, 2, cell], 1),
            ([0, far.wrapping_neg(), 3, 2, cell], 1),
            ([0, 0, 3, 2, 0], 1),
            ([0, 0, 3, 2, f64::NAN.to_bits()], 1),
        ] {
            let why = read_with(window, pages).unwrap_err();
            assert!(why.contains("no valid position, size or cell"), "{window:?}: {why}");
        }
        std::fs::remove_file(&path).unwrap();
    }
}
