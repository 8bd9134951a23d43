//! Rasters: layers over the whole world, in memory or on disk.

use crate::pages::{self, Pages, SIDE};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::resample::{self, LayerKind, NOWHERE};
use orogen_noise::Points;
use std::path::Path;

/// Samples over a window, which are written and read in parts. The result does not depend on where they are stored.
#[derive(Debug)]
pub struct Raster {
    kept: Kept,
}

#[derive(Debug)]
enum Kept {
    Memory(Grid),
    Disk(Pages),
}

impl Raster {
    /// A raster in memory.
    #[must_use]
    pub fn in_memory(grid: Grid) -> Raster {
        Raster { kept: Kept::Memory(grid) }
    }

    /// A raster in pages on disk.
    pub fn on_disk(pages: Pages) -> Raster {
        Raster { kept: Kept::Disk(pages) }
    }

    /// A copy on disk, in a separate file in `folder`.
    ///
    /// # Errors
    /// If the disk is full or fails.
    pub fn copied_to_disk(&self, folder: &Path) -> Result<Raster> {
        let mut pages = Pages::scratch(folder, *self.window())?;
        for part in self.window().tiles(SIDE) {
            pages.put(&self.get(&part)?)?;
        }
        Ok(Raster::on_disk(pages))
    }

    /// Memory needed for a raster on disk, in bytes.
    #[must_use]
    pub fn memory_on_disk(window: &Window) -> u64 {
        pages::memory(window)
    }

    /// Memory that this raster uses, in bytes.
    pub fn memory(&self) -> u64 {
        match &self.kept {
            Kept::Memory(grid) => grid.window().len() as u64 * 4,
            Kept::Disk(pages) => Raster::memory_on_disk(pages.window()),
        }
    }

    /// Whether the raster is on disk.
    pub fn is_on_disk(&self) -> bool {
        matches!(self.kept, Kept::Disk(_))
    }

    /// The window of the samples.
    pub fn window(&self) -> &Window {
        match &self.kept {
            Kept::Memory(grid) => grid.window(),
            Kept::Disk(pages) => pages.window(),
        }
    }

    /// Writes the part of `part` that overlaps the raster.
    ///
    /// # Errors
    /// If the disk is full or fails.
    pub fn put(&mut self, part: &Grid) -> Result<()> {
        match &mut self.kept {
            Kept::Memory(grid) => {
                grid.paste(part);
                Ok(())
            }
            Kept::Disk(pages) => pages.put(part),
        }
    }

    /// The samples of a window, which must be inside the raster.
    ///
    /// # Errors
    /// If the window is not inside the raster, or if the disk fails.
    pub fn get(&self, window: &Window) -> Result<Grid> {
        if !self.window().contains(window) {
            let message = format!("{window:?} is not part of the raster over {:?}", self.window());
            return Err(Error::new(ErrorKind::Request, message));
        }
        match &self.kept {
            Kept::Memory(grid) => Ok(grid.crop(window).unwrap_or_else(|| Grid::filled(*window, f32::NAN))),
            Kept::Disk(pages) => pages.get(window),
        }
    }

    /// Reads the raster at all points into `out`, interpolated according to `kind`. Outside the raster the samples at
    /// its border are repeated. A point that is not finite gives NaN.
    ///
    /// # Errors
    /// If the disk fails.
    pub fn read(&self, kind: LayerKind, at: &Points, out: &mut [f32]) -> Result<()> {
        match &self.kept {
            Kept::Memory(grid) => resample::read(grid, kind, at, out),
            Kept::Disk(pages) => read_pages(pages, kind, at, out)?,
        }
        Ok(())
    }
}

/// Maximum number of samples that are fetched at once.
const FETCHED: usize = 1 << 18;

/// Reads nearby points from one grid around them: all points at once if that grid is small, otherwise in smaller and
/// smaller runs.
fn read_pages(pages: &Pages, kind: LayerKind, at: &Points, out: &mut [f32]) -> Result<()> {
    if let Points::Lattice { xs, ys } = at {
        let around = around(pages.window(), xs.iter().copied(), ys.iter().copied());
        if around.len() <= FETCHED {
            resample::read(&pages.get(&around)?, kind, at, out);
            return Ok(());
        }
    }
    // A run of consecutive points. Its length is limited, so that the far ends of a lattice are not read repeatedly.
    const RUN: usize = 4096;
    let mut runs: Vec<(usize, usize)> = (0..out.len()).step_by(RUN).map(|k| (k, (k + RUN).min(out.len()))).collect();
    let (mut xs, mut ys) = (Vec::with_capacity(RUN), Vec::with_capacity(RUN));
    while let Some((start, end)) = runs.pop() {
        xs.clear();
        ys.clear();
        for k in start..end {
            let (x, y) = at.position(k).unwrap_or(NOWHERE);
            xs.push(x);
            ys.push(y);
        }
        let around = around(pages.window(), xs.iter().copied(), ys.iter().copied());
        if around.len() > FETCHED && end - start > 1 {
            let middle = usize::midpoint(start, end);
            runs.extend([(middle, end), (start, middle)]);
            continue;
        }
        resample::read(&pages.get(&around)?, kind, &Points::Scattered { x: &xs, y: &ys }, &mut out[start..end]);
    }
    Ok(())
}

/// The samples of `window` that may be read for these positions; at least one, so that positions outside the window get
/// samples at its border.
fn around(window: &Window, xs: impl Iterator<Item = f64>, ys: impl Iterator<Item = f64>) -> Window {
    fn span(positions: impl Iterator<Item = f64>, cell: f64, first: i64, last: i64) -> (i64, usize) {
        let indices =
            positions.filter(|position| position.is_finite()).map(|position| resample::split(position, cell).0);
        let (low, high) = indices.fold((i64::MAX, i64::MIN), |(low, high), i| (low.min(i), high.max(i)));
        let start = low.saturating_sub(1).clamp(first, last);
        let end = high.saturating_add(2).clamp(start, last);
        (start, (end - start) as usize + 1)
    }
    let (x, width) = span(xs, window.cell, window.x, window.right() - 1);
    let (y, height) = span(ys, window.cell, window.y, window.bottom() - 1);
    Window { x, y, width, height, cell: window.cell }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pattern(window: Window) -> Grid {
        let data = (0..window.len()).map(|k| ((k * 7919) % 10_007) as f32 * 0.37 - 500.0).collect();
        Grid::from_data(window, data).unwrap()
    }

    fn scratch(window: Window) -> Raster {
        Raster::on_disk(Pages::scratch(&std::env::temp_dir(), window).unwrap())
    }

    #[test]
    fn disk_and_memory_read_the_same_bits() {
        for cell in [10.24, 0.1, 1.0 / 3.0] {
            let window = Window::new(700, 530, cell).at(-2, -2);
            let grid = pattern(window);
            let (memory, mut disk) = (Raster::in_memory(grid.clone()), scratch(window));
            // Parts that do not coincide with pages, each written once, in reverse order.
            let parts: Vec<Window> = window.tiles(190).collect();
            parts.iter().rev().for_each(|part| disk.put(&grid.crop(part).unwrap()).unwrap());
            let extent = [700.0 * cell, 530.0 * cell];
            let xs: Vec<f64> = (0..90).map(|i| -3.0 * cell + f64::from(i) * extent[0] / 80.0).collect();
            let ys: Vec<f64> = (0..70).map(|j| -9.0 * cell + f64::from(j) * extent[1] / 60.0).collect();
            let near: Vec<f64> = (0..90).map(|i| (f64::from(i) * 0.5 + 300.0) * cell).collect();
            let dx: Vec<f32> = (0..90 * 70).map(|k| ((k * 31) % 4001) as f32 * cell as f32).collect();
            let wild = [f64::NAN, 5.5 * cell, 1e300, -1e300, f64::INFINITY];
            for kind in [LayerKind::Height, LayerKind::Label, LayerKind::Flow] {
                for at in [
                    Points::Lattice { xs: &xs, ys: &ys },
                    Points::Lattice { xs: &near, ys: &near },
                    Points::Displaced { xs: &xs, ys: &ys, dx: &dx, dy: &dx },
                    Points::Scattered { x: &wild, y: &[0.0, 7.25 * cell, 1.0, 2.0, 3.0] },
                ] {
                    let (mut a, mut b) = (vec![0.0f32; at.len()], vec![1.0f32; at.len()]);
                    memory.read(kind, &at, &mut a).unwrap();
                    disk.read(kind, &at, &mut b).unwrap();
                    let bits = |samples: &[f32]| samples.iter().map(|sample| sample.to_bits()).collect::<Vec<_>>();
                    assert_eq!(bits(&a), bits(&b), "{kind:?}");
                }
            }
            let part = Window::new(300, 290, cell).at(200, 111);
            assert_eq!(memory.get(&part).unwrap(), disk.get(&part).unwrap());
            assert!(disk.get(&part.at(600, 0)).is_err() && memory.get(&part.at(600, 0)).is_err());
        }
    }

    #[test]
    fn what_was_never_written_is_zero_and_spilling_changes_nothing() {
        let window = Window::new(300, 20, 1.0).at(-2, 5);
        let mut raster = scratch(window);
        assert_eq!(raster.get(&window).unwrap(), Grid::filled(window, 0.0));
        // If the window is larger than the raster, only the part inside is written.
        raster.put(&pattern(window.grown(3))).unwrap();
        assert_eq!(raster.get(&window).unwrap(), pattern(window.grown(3)).crop(&window).unwrap());
        let spilled = Raster::in_memory(pattern(window)).copied_to_disk(&std::env::temp_dir()).unwrap();
        assert!(spilled.is_on_disk());
        assert_eq!(spilled.get(&window).unwrap(), pattern(window));
        assert!(Pages::scratch(Path::new("/dev/null/no"), window).is_err());
    }

    /// One pass over all tiles: every sample becomes the mean of itself and its neighbors in `from`.
    fn sweep(from: &Raster, to: &mut Raster, side: usize) {
        let whole = *from.window();
        for tile in whole.tiles(side) {
            let near = tile.grown(1);
            let (left, top) = (near.x.max(whole.x), near.y.max(whole.y));
            let (right, bottom) = (near.right().min(whole.right()), near.bottom().min(whole.bottom()));
            let (width, height) = ((right - left) as usize, (bottom - top) as usize);
            let seen = from.get(&Window { x: left, y: top, width, height, ..whole }).unwrap();
            let at = |x: i64, y: i64| {
                seen[((x.clamp(left, right - 1) - left) as usize, (y.clamp(top, bottom - 1) - top) as usize)]
            };
            let mut out = Grid::filled(tile, 0.0);
            for j in 0..tile.height {
                for i in 0..tile.width {
                    let (x, y) = (tile.x + i as i64, tile.y + j as i64);
                    let sum = at(x, y) + at(x - 1, y) + at(x + 1, y) + at(x, y - 1) + at(x, y + 1);
                    out.row_mut(j)[i] = sum / 5.0;
                }
            }
            to.put(&out).unwrap();
        }
    }

    #[test]
    fn several_passes_over_tiles_on_disk_are_those_over_the_whole_in_memory() {
        let window = Window::new(530, 270, 1.0).at(-2, -2);
        let [mut a, mut b] = [pattern(window), Grid::filled(window, 0.0)].map(Raster::in_memory);
        let (mut c, mut d) = (scratch(window), scratch(window));
        c.put(&pattern(window)).unwrap();
        for side in [100, 256, 333] {
            sweep(&a, &mut b, 1000);
            sweep(&c, &mut d, side);
            (a, b, c, d) = (b, a, d, c);
            assert_eq!(a.get(&window).unwrap(), c.get(&window).unwrap(), "tiles of {side}");
        }
    }
}
