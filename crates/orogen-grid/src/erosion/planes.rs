//! Several values per cell, stored row by row, and stencil passes over them that stay in the cache.

use crate::error::Result;
use crate::grid::{Grid, Window};
use crate::parallel;
use crate::progress::Progress;

/// N planes of one size. The rows of all planes are adjacent in memory, so that a pass down the rows reads one
/// contiguous range.
#[derive(Debug, Clone, PartialEq)]
pub struct Planes<const N: usize> {
    width: usize,
    height: usize,
    data: Vec<f32>,
}

impl<const N: usize> Planes<N> {
    /// Planes of zeros.
    #[must_use]
    pub fn new(width: usize, height: usize) -> Planes<N> {
        Planes { width, height, data: vec![0.0; width * height * N] }
    }

    /// Number of samples per row.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Number of rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// Row `j` of every plane.
    #[inline(always)]
    #[must_use]
    pub fn row(&self, j: usize) -> [&[f32]; N] {
        let row = &self.data[j * N * self.width..(j + 1) * N * self.width];
        std::array::from_fn(|plane| &row[plane * self.width..(plane + 1) * self.width])
    }

    /// Row `j` of every plane, mutable.
    #[inline(always)]
    pub fn row_mut(&mut self, j: usize) -> [&mut [f32]; N] {
        planes_of(&mut self.data[j * N * self.width..(j + 1) * N * self.width], self.width)
    }

    /// Plane `plane` as a grid over `window`, which must have the same number of samples.
    #[must_use]
    pub fn grid(&self, plane: usize, window: Window) -> Grid {
        let mut grid = Grid::filled(window, 0.0f32);
        let rows = grid.data_mut().chunks_mut(window.width.max(1)).enumerate();
        parallel::for_each(rows, |(j, row)| row.copy_from_slice(self.row(j)[plane]));
        grid
    }

    /// Fills plane `plane` from a grid with the same number of samples.
    pub fn fill(&mut self, plane: usize, grid: &Grid) {
        let height = self.height;
        parallel::for_each(self.rows_mut(0, height).into_iter().enumerate(), |(j, row)| {
            row[plane].copy_from_slice(grid.row(j));
        });
    }

    /// Sets row `j` of plane `plane`.
    pub fn set(&mut self, plane: usize, j: usize, values: &[f32]) {
        self.row_mut(j)[plane].copy_from_slice(values);
    }

    /// Rows `j - 1`, `j` and `j + 1` of every plane, mutable.
    #[inline(always)]
    pub fn three(&mut self, j: usize) -> [[&mut [f32]; N]; 3] {
        let (width, all) = (self.width.max(1), N * self.width);
        let mut rows = self.data[(j - 1) * all..(j + 2) * all].chunks_exact_mut(width);
        std::array::from_fn(|_| std::array::from_fn(|_| rows.next().unwrap_or_default()))
    }

    /// Replaces the planes with a copy of the rows `first..last` of `from`.
    pub fn copy_rows(&mut self, from: &Planes<N>, first: usize, last: usize) {
        let all = N * from.width;
        (self.width, self.height) = (from.width, last - first);
        self.data.clear();
        self.data.extend_from_slice(&from.data[first * all..last * all]);
    }

    /// `height` rows from `first`, each mutable.
    pub fn rows_mut(&mut self, first: usize, height: usize) -> Vec<[&mut [f32]; N]> {
        let (width, all) = (self.width, N * self.width);
        let rows = self.data[first * all..(first + height) * all].chunks_exact_mut(all.max(1));
        rows.map(|row| planes_of(row, width)).collect()
    }

    /// Like [`Planes::rows_mut`], grouped in bands of `rows` rows.
    pub fn bands_mut(&mut self, first: usize, height: usize, rows: usize) -> Vec<Vec<[&mut [f32]; N]>> {
        let mut left = self.rows_mut(first, height).into_iter();
        (0..height.div_ceil(rows)).map(|_| left.by_ref().take(rows).collect()).collect()
    }

    /// Changes the size and discards the values; memory is reused.
    pub fn resize(&mut self, width: usize, height: usize) {
        (self.width, self.height) = (width, height);
        let size = width * height * N;
        if size > self.data.capacity() {
            // Newly allocated memory is zero, and the thread that uses it is the first to touch it.
            self.data = vec![0.0; size];
        } else {
            self.data.resize(size, 0.0);
        }
    }
}

/// A row's planes.
#[inline(always)]
fn planes_of<const N: usize>(row: &mut [f32], width: usize) -> [&mut [f32]; N] {
    let mut planes = row.chunks_exact_mut(width.max(1));
    std::array::from_fn(|_| planes.next().unwrap_or_default())
}

/// One pass of a stencil.
pub trait Pass<const N: usize>: Sync {
    /// The radius that the stencil reads, in cells.
    const RADIUS: usize;

    /// Computes `to` from `from`. `to` is smaller by the radius on each side. `scratch` is memory that is reused
    /// between calls.
    fn make(&self, from: &Planes<N>, to: &mut Planes<N>, scratch: &mut Vec<f32>);
}

/// Number of passes over a band of rows before it is written back.
const AT_ONCE: usize = 8;

/// Number of rows of a band, such that the buffers of two bands fit in a core's own cache.
const BAND: usize = 64;

/// The planes after `passes` passes, smaller by the radius per pass on each side. Bands of rows run in parallel, each
/// for several passes while it is in the cache. Rows that neighboring bands need from each other are computed twice.
/// The bits do not depend on the number of threads.
///
/// # Errors
/// If the work is cancelled.
pub fn run<const N: usize, P: Pass<N>>(
    mut planes: Planes<N>,
    passes: usize,
    pass: &P,
    progress: &Progress,
) -> Result<Planes<N>> {
    let mut next = Planes::new(0, 0);
    let mut left = passes;
    progress.expect(passes as f64);
    while left > 0 {
        progress.check()?;
        let now = left.min(AT_ONCE);
        let inset = now * P::RADIUS;
        let (width, height) = (planes.width.saturating_sub(2 * inset), planes.height.saturating_sub(2 * inset));
        next.resize(width, height);
        let from = &planes;
        let bands = next.bands_mut(0, height, BAND).into_iter().enumerate();
        let work = now as f64 / bands.len().max(1) as f64;
        parallel::try_for_each_init(
            bands,
            || (Planes::new(0, 0), Planes::new(0, 0), Vec::new()),
            |(here, spare, scratch), (band, mut out)| {
                progress.check()?;
                let top = band * BAND;
                here.copy_rows(from, top, top + out.len() + 2 * inset);
                for _ in 0..now {
                    spare.resize(here.width - 2 * P::RADIUS, here.height - 2 * P::RADIUS);
                    pass.make(here, spare, scratch);
                    std::mem::swap(here, spare);
                }
                for (j, out) in out.iter_mut().enumerate() {
                    out.iter_mut().zip(here.row(j)).for_each(|(out, row)| out.copy_from_slice(row));
                }
                progress.advance(work);
                Ok(())
            },
        )?;
        std::mem::swap(&mut planes, &mut next);
        left -= now;
    }
    Ok(planes)
}
