//! Filters of heights in the frequency domain.

use crate::analysis::fourier::Fourier;
use crate::error::{Error, Result};
use crate::grid::{Grid, Window};
use crate::parallel;
use crate::progress::Progress;

/// A periodic lattice around a window, whose sides are powers of two.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Lattice {
    columns: usize,
    rows: usize,
    window: Window,
}

/// Number of columns or rows that are transformed together. A cache line holds four complex numbers.
const TOGETHER: usize = 8;

/// Minimum of the allowed width of the strip beyond the window, in samples. For small windows this costs little.
const MIN_STRIP: usize = 256;

impl Lattice {
    /// The lattice with a strip of at least `reach` metres beyond the window. The strip is at most as wide as the
    /// window or 256 samples, whichever is more.
    pub(super) fn new(window: &Window, reach: f64) -> Lattice {
        let largest = window.width.max(window.height).max(MIN_STRIP);
        let strip = ((reach / window.cell).ceil() as usize).min(largest);
        let side = |length: usize| length.saturating_add(strip).next_power_of_two().max(4);
        Lattice { columns: side(window.width), rows: side(window.height), window: *window }
    }

    /// Number of columns of the transform of real rows.
    fn half(&self) -> usize {
        self.columns / 2 + 1
    }

    /// Memory of a filter, in bytes: the transforms of all rows, and the transforms of the window's rows after the
    /// columns.
    pub(super) fn memory(&self) -> u64 {
        (self.half() as u64).saturating_mul((self.rows + self.window.height) as u64).saturating_mul(16)
    }

    /// Applies `of` to the samples and filters the result with `response`, which returns a complex factor for a wave
    /// with the given wavenumbers in 1/m to the east and to the south. Beyond each side of the window, heights change
    /// smoothly to those of the opposite side.
    pub(super) fn filtered(
        &self,
        heights: &Grid,
        of: impl Fn(f32) -> f64 + Sync,
        response: impl Fn([f64; 2]) -> [f64; 2] + Sync,
        progress: &Progress,
    ) -> Result<Grid> {
        let window = self.window;
        let mut out = Grid::filled(window, 0.0f32);
        let (Some(along), Some(across)) = (Fourier::new(self.columns), Fourier::new(self.rows)) else { return Ok(out) };
        if window.is_empty() || *heights.window() != window {
            return Ok(out);
        }
        progress.expect(4.0);
        let rows = self.transformed_rows(heights, &of, &along, progress)?;
        let columns = self.filtered_columns(&rows, &response, &across, progress)?;
        drop(rows);
        self.inverse_rows(&columns, &along, &mut out, progress)?;
        Ok(out)
    }

    /// The transforms of all rows, row by row. Two real rows are transformed at once, as a real and an imaginary part.
    fn transformed_rows(
        &self,
        heights: &Grid,
        of: &(impl Fn(f32) -> f64 + Sync),
        along: &Fourier,
        progress: &Progress,
    ) -> Result<Vec<[f64; 2]>> {
        let (n, half) = (self.columns, self.half());
        let mut rows = vec![[0.0; 2]; half * self.rows];
        let work = 2.0 / self.rows as f64;
        let scratch = || (vec![0.0; n], vec![0.0; n], vec![[0.0; 2]; n]);
        parallel::try_for_each_init(rows.chunks_mut(2 * half).enumerate(), scratch, |(a, b, both), (pair, out)| {
            progress.step(work)?;
            self.extended_row(heights, of, 2 * pair, a);
            self.extended_row(heights, of, 2 * pair + 1, b);
            for ((z, a), b) in both.iter_mut().zip(a.iter()).zip(b.iter()) {
                *z = [*a, *b];
            }
            along.transform(both);
            let (first, second) = out.split_at_mut(half);
            for (k, (a, b)) in first.iter_mut().zip(second).enumerate() {
                let ([x, y], [u, v]) = (both[k], both[(n - k) % n]);
                (*a, *b) = ([0.5 * (x + u), 0.5 * (y - v)], [0.5 * (y + v), 0.5 * (u - x)]);
            }
            Ok::<(), Error>(())
        })?;
        Ok(rows)
    }

    /// Row `j` of the lattice.
    fn extended_row(&self, heights: &Grid, of: &impl Fn(f32) -> f64, j: usize, out: &mut [f64]) {
        let Window { width, height, .. } = self.window;
        let (inside, strip) = out.split_at_mut(width);
        if j < height {
            inside.iter_mut().zip(heights.row(j)).for_each(|(value, sample)| *value = of(*sample));
        } else {
            let share = fade(j - height, self.rows - height);
            for ((value, last), first) in inside.iter_mut().zip(heights.row(height - 1)).zip(heights.row(0)) {
                *value = mixed(of(*last), of(*first), share);
            }
        }
        let (first, last, count) = (inside[0], inside[width - 1], strip.len());
        strip.iter_mut().enumerate().for_each(|(i, value)| *value = mixed(last, first, fade(i, count)));
    }

    /// The filtered transforms at the window's rows, column by column.
    fn filtered_columns(
        &self,
        rows: &[[f64; 2]],
        response: &(impl Fn([f64; 2]) -> [f64; 2] + Sync),
        across: &Fourier,
        progress: &Progress,
    ) -> Result<Vec<[f64; 2]>> {
        let (half, height) = (self.half(), self.window.height);
        let mut columns = vec![[0.0; 2]; half * height];
        let work = TOGETHER as f64 / half as f64;
        let (wave, scale) = (self.waves(), 1.0 / (self.columns as f64 * self.rows as f64));
        let scratch = || vec![[0.0; 2]; TOGETHER * self.rows];
        parallel::try_for_each_init(columns.chunks_mut(TOGETHER * height).enumerate(), scratch, |block, (at, out)| {
            progress.step(2.0 * work)?;
            let first = at * TOGETHER;
            let count = out.len() / height;
            for (j, row) in rows.chunks_exact(half).enumerate() {
                for (c, value) in row[first..first + count].iter().enumerate() {
                    block[c * self.rows + j] = *value;
                }
            }
            for (c, out) in out.chunks_exact_mut(height).enumerate() {
                let column = &mut block[c * self.rows..][..self.rows];
                across.transform(column);
                for (l, value) in column.iter_mut().enumerate() {
                    let [re, im] = wave(first + c, l).map_or([0.0; 2], response);
                    let [x, y] = *value;
                    // Conjugated: the inverse transform is the transform between two conjugations.
                    *value = [(x * re - y * im) * scale, -(x * im + y * re) * scale];
                }
                across.transform(column);
                out.iter_mut().zip(column.iter()).for_each(|(out, [x, y])| *out = [*x, -*y]);
            }
            Ok::<(), Error>(())
        })?;
        Ok(columns)
    }

    /// The wavenumbers of a column and a row of the transform. `None` at half the sampling frequency, where a wave has
    /// no sign.
    fn waves(&self) -> impl Fn(usize, usize) -> Option<[f64; 2]> + Sync + use<> {
        let (columns, rows, cell) = (self.columns, self.rows, self.window.cell);
        let [east, south] = [columns, rows].map(|side| std::f64::consts::TAU / (side as f64 * cell));
        move |k, l| {
            let l_signed = if l < rows / 2 { l as f64 } else { l as f64 - rows as f64 };
            (k != columns / 2 && l != rows / 2).then_some([k as f64 * east, l_signed * south])
        }
    }

    /// The rows of the window, from their filtered transforms.
    fn inverse_rows(&self, columns: &[[f64; 2]], along: &Fourier, out: &mut Grid, progress: &Progress) -> Result<()> {
        let Window { width, height, .. } = self.window;
        let n = self.columns;
        let work = TOGETHER as f64 / height as f64;
        let scratch = || vec![[0.0; 2]; TOGETHER / 2 * n];
        let rows = out.data_mut().chunks_mut(TOGETHER * width).enumerate();
        parallel::try_for_each_init(rows, scratch, |pairs, (at, out)| {
            progress.step(work)?;
            let (first, count) = (at * TOGETHER, out.len() / width);
            for (k, column) in columns.chunks_exact(height).enumerate() {
                let values = &column[first..first + count];
                for (pair, values) in values.chunks(2).enumerate() {
                    let ([a, b], [c, d]) = (values[0], values.get(1).copied().unwrap_or_default());
                    // The conjugate of both rows, and of the waves in the opposite direction.
                    let both = &mut pairs[pair * n..][..n];
                    both[(n - k) % n] = [a + d, b - c];
                    both[k] = [a - d, -(b + c)];
                }
            }
            for (rows, both) in out.chunks_mut(2 * width).zip(pairs.chunks_exact_mut(n)) {
                along.transform(both);
                let (a, b) = rows.split_at_mut(width);
                a.iter_mut().zip(both.iter()).for_each(|(out, z)| *out = z[0] as f32);
                b.iter_mut().zip(both.iter()).for_each(|(out, z)| *out = -z[1] as f32);
            }
            Ok::<(), Error>(())
        })
    }
}

/// The weight of the opposite side at sample `i` of `count` beyond a side.
fn fade(i: usize, count: usize) -> f64 {
    let t = (i + 1) as f64 / (count + 1) as f64;
    t * t * (3.0 - 2.0 * t)
}

fn mixed(a: f64, b: f64, share: f64) -> f64 {
    a + (b - a) * share
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noise(window: Window) -> Grid {
        let mut grid = Grid::filled(window, 0.0f32);
        let sample = |k: usize| (k as u32).wrapping_mul(2_654_435_761) as f32 / u32::MAX as f32;
        grid.data_mut().iter_mut().enumerate().for_each(|(k, value)| *value = sample(k));
        grid
    }

    #[test]
    fn a_factor_of_one_changes_only_the_finest_waves() {
        for window in [Window::new(37, 50, 10.0), Window::new(64, 9, 3.0), Window::new(1, 1, 1.0)] {
            // Smooth, so that the wave at half the sampling frequency is absent.
            let mut grid = noise(window);
            for j in 0..window.height {
                for i in 0..window.width {
                    grid[(i, j)] = libm::sin(i as f64 * 0.1) as f32 + libm::cos(j as f64 * 0.07) as f32;
                }
            }
            let lattice = Lattice::new(&window, 400.0);
            let same = lattice.filtered(&grid, f64::from, |_| [1.0, 0.0], &Progress::none()).unwrap();
            for (a, b) in same.data().iter().zip(grid.data()) {
                assert!((a - b).abs() < 1e-3, "{a} {b}");
            }
        }
    }

    #[test]
    fn a_slope_is_the_derivative() {
        let window = Window::new(128, 128, 5.0);
        let mut grid = Grid::filled(window, 0.0f32);
        for j in 0..128 {
            for i in 0..128 {
                let (x, y) = (window.east(i) - 300.0, window.south(j) - 320.0);
                grid[(i, j)] = libm::exp(-(x * x + 0.5 * y * y) / 3000.0) as f32;
            }
        }
        let lattice = Lattice::new(&window, 100.0);
        let [east, south] = [0, 1]
            .map(|axis| lattice.filtered(&grid, f64::from, move |wave| [0.0, wave[axis]], &Progress::none()).unwrap());
        for j in 1..127 {
            for i in 1..127 {
                let (x, y) = (window.east(i) - 300.0, window.south(j) - 320.0);
                let h = libm::exp(-(x * x + 0.5 * y * y) / 3000.0);
                assert!((f64::from(east[(i, j)]) + 2.0 * x / 3000.0 * h).abs() < 1e-5);
                assert!((f64::from(south[(i, j)]) + y / 3000.0 * h).abs() < 1e-5);
            }
        }
    }

    #[test]
    fn the_strip_is_as_wide_as_the_reach_or_the_window() {
        let sides = |width: usize, reach: f64| {
            let lattice = Lattice::new(&Window::new(width, width / 2, 10.0), reach);
            [lattice.columns, lattice.rows]
        };
        assert_eq!(sides(1000, 200.0), [1024, 1024]);
        assert_eq!(sides(1000, 300.0), [2048, 1024]);
        assert_eq!(sides(1000, 1e9), [2048, 2048]);
        assert_eq!(sides(20, 1e9), [512, 512]);
    }
}
