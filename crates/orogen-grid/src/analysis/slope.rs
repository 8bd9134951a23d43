//! Slopes by Horn's method.
//!
//! Horn's method uses the 3 x 3 neighborhood a b c / d e f / g h i of cells of c metres (B. K. P. Horn, "Hill shading
//! and the reflectance map", Proceedings of the IEEE 69(1), 1981):
//!
//! ```text
//! p = ((c - a) + 2 (f - d) + (i - g)) / 8c      towards the east
//! q = ((a - g) + 2 (b - h) + (c - i)) / 8c      towards the north (up the page)
//! ```
//!
//! Every function here takes a grid with one more sample on each side than its result, so that the result for a tile
//! equals the same part of the result for the whole grid. At the edge of a world, [`extended`] adds that border.
//!
//! **Missing samples.** The slope of a sample that is not finite is NaN. A neighbor that is not finite counts as level
//! with the center.

use crate::grid::{Grid, Window};
use orogen_simd::{Body, Simd, dispatch};

/// The gradient at one sample, in metres per metre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gradient {
    /// p: the rise per metre eastward.
    pub east: f32,
    /// q: the rise per metre northward (up the page).
    pub north: f32,
}

impl Gradient {
    /// The steepest rise per metre: the tangent of the slope angle.
    #[inline(always)]
    #[must_use]
    pub fn steepness(&self) -> f32 {
        (self.east * self.east + self.north * self.north).sqrt()
    }

    /// The slope angle in degrees, 0 to 90.
    #[inline(always)]
    #[must_use]
    pub fn degrees(&self) -> f32 {
        libm::atanf(self.steepness()).to_degrees()
    }

    /// The upward unit normal: east, north and up.
    #[must_use]
    pub fn normal(&self) -> [f32; 3] {
        let length = (1.0 + self.east * self.east + self.north * self.north).sqrt();
        [-self.east / length, -self.north / length, 1.0 / length]
    }
}

/// Computes the gradients at the inner samples of three adjacent rows, given from north to south. Calls `each` with an
/// index from 0 and the gradient, for the columns 1 to width - 2.
pub fn gradients_between(rows: [&[f32]; 3], cell: f64, mut each: impl FnMut(usize, Gradient)) {
    let scale = (1.0 / (8.0 * cell)) as f32;
    let [above, here, below] = rows;
    let triples = above.windows(3).zip(here.windows(3)).zip(below.windows(3));
    for (i, ((n, m), s)) in triples.enumerate() {
        // Differences first: neighboring heights are similar, so little precision is lost far above zero.
        let east = ((n[2] - n[0]) + 2.0 * (m[2] - m[0]) + (s[2] - s[0])) * scale;
        let north = ((n[0] - s[0]) + 2.0 * (n[1] - s[1]) + (n[2] - s[2])) * scale;
        let gradient = Gradient { east, north };
        // One test covers the common case. Missing samples and overflowing differences are handled separately.
        each(i, if (east + north).is_finite() && m[1].is_finite() { gradient } else { repaired([n, m, s], cell) });
    }
}

/// Fills `out` with a value of the gradient at each inner sample of three adjacent rows, given from north to south. It
/// is shorter than the rows by two.
pub fn values_between(rows: [&[f32]; 3], cell: f64, out: &mut [f32], value: impl Fn(Gradient) -> f32 + Copy) {
    if !dispatch(Finite { rows, cell, value, out: &mut *out }) {
        gradients_between(rows, cell, |i, gradient| out[i] = value(gradient));
    }
}

/// Computes the values of a row under the assumption that no sample is missing; returns whether this is true.
struct Finite<'a, V> {
    rows: [&'a [f32]; 3],
    cell: f64,
    value: V,
    out: &'a mut [f32],
}

impl<V: Fn(Gradient) -> f32 + Copy> Body for Finite<'_, V> {
    type Output = bool;

    #[inline(always)]
    fn run<S: Simd>(self, _: S) -> bool {
        let n = self.out.len();
        let [[a, b, c], [d, e, f], [g, h, k]] = self.rows.map(|row| [&row[..n], &row[1..=n], &row[2..n + 2]]);
        let (scale, value) = ((1.0 / (8.0 * self.cell)) as f32, self.value);
        let mut missing = 0u32;
        for (i, out) in self.out.iter_mut().enumerate() {
            // The same sums as in `gradients_between`, in the same order, so that the bits are the same.
            let east = ((c[i] - a[i]) + 2.0 * (f[i] - d[i]) + (k[i] - g[i])) * scale;
            let north = ((a[i] - g[i]) + 2.0 * (b[i] - h[i]) + (c[i] - k[i])) * scale;
            *out = value(Gradient { east, north });
            // A value that is not finite gives NaN when multiplied by 0.
            let zero = ((east + north) + e[i]) * 0.0;
            missing |= u32::from(zero != 0.0);
        }
        missing == 0
    }
}

/// The gradients at every sample of `grid` except its border: rise per metre to the east and to the north.
#[must_use]
pub fn gradients(grid: &Grid) -> [Grid; 2] {
    let window = inner(grid.window());
    let [mut east, mut north] = [(); 2].map(|()| Grid::filled(window, 0.0));
    for j in 0..window.height {
        let rows = [grid.row(j), grid.row(j + 1), grid.row(j + 2)];
        let (east, north) = (east.row_mut(j), north.row_mut(j));
        gradients_between(rows, window.cell, |i, gradient| (east[i], north[i]) = (gradient.east, gradient.north));
    }
    [east, north]
}

/// The unit normals at every sample of `grid` except its border: their components to the east, north and up.
#[must_use]
pub fn normals(grid: &Grid) -> [Grid; 3] {
    let window = inner(grid.window());
    let mut parts = [(); 3].map(|()| Grid::filled(window, 0.0));
    for j in 0..window.height {
        let rows = [grid.row(j), grid.row(j + 1), grid.row(j + 2)];
        gradients_between(rows, window.cell, |i, gradient| {
            parts.iter_mut().zip(gradient.normal()).for_each(|(part, value)| part.row_mut(j)[i] = value);
        });
    }
    parts
}

/// The gradient where a sample is not finite or a difference overflows f32.
#[cold]
fn repaired(rows: [&[f32]; 3], cell: f64) -> Gradient {
    let middle = rows[1][1];
    if !middle.is_finite() {
        return Gradient { east: f32::NAN, north: f32::NAN };
    }
    let at = |j: usize, i: usize| f64::from(if rows[j][i].is_finite() { rows[j][i] } else { middle });
    let east = (at(0, 2) - at(0, 0)) + 2.0 * (at(1, 2) - at(1, 0)) + (at(2, 2) - at(2, 0));
    let north = (at(0, 0) - at(2, 0)) + 2.0 * (at(0, 1) - at(2, 1)) + (at(0, 2) - at(2, 2));
    let fit = |rise: f64| (rise / (8.0 * cell)).clamp(f64::from(f32::MIN), f64::from(f32::MAX)) as f32;
    Gradient { east: fit(east), north: fit(north) }
}

/// Applies `value` to the gradient at every sample of `grid` except its border of one sample.
pub fn from_gradients(grid: &Grid, value: impl Fn(Gradient) -> f32) -> Grid {
    let window = inner(grid.window());
    let mut out = Grid::filled(window, 0.0);
    for j in 0..window.height {
        let rows = [grid.row(j), grid.row(j + 1), grid.row(j + 2)];
        values_between(rows, window.cell, out.row_mut(j), &value);
    }
    out
}

/// The slope angles in degrees, 0 to 90, of the inner samples of three adjacent rows, like [`values_between`].
pub fn degrees_between(rows: [&[f32]; 3], cell: f64, out: &mut [f32]) {
    values_between(rows, cell, out, |gradient| gradient.degrees());
}

/// The slopes, rise over run, of the inner samples of three adjacent rows, like [`values_between`].
pub fn steepness_between(rows: [&[f32]; 3], cell: f64, out: &mut [f32]) {
    values_between(rows, cell, out, |gradient| gradient.steepness());
}

/// The slope, rise over run, at every sample of `grid` except its border of one sample.
#[must_use]
pub fn steepness(grid: &Grid) -> Grid {
    from_gradients(grid, |gradient| gradient.steepness())
}

/// The slope angle in degrees, 0 to 90, at every sample of `grid` except its border of one sample.
#[must_use]
pub fn slope_degrees(grid: &Grid) -> Grid {
    from_gradients(grid, |gradient| gradient.degrees())
}

/// The window without a border of one sample; possibly empty.
#[must_use]
pub fn inner(window: &Window) -> Window {
    let (width, height) = (window.width.saturating_sub(2), window.height.saturating_sub(2));
    match width == 0 || height == 0 {
        true => Window { x: window.x + 1, y: window.y + 1, width: 0, height: 0, cell: window.cell },
        false => Window { x: window.x + 1, y: window.y + 1, width, height, cell: window.cell },
    }
}

/// The grid extended by one sample on each side with linear extrapolation, for the edges of a world. With Horn's
/// weights this gives one-sided slopes at the border.
#[must_use]
pub fn extended(grid: &Grid) -> Grid {
    let mut out = Grid::filled(grid.window().grown(1), f32::NAN);
    let (width, height) = (grid.width(), grid.height());
    if grid.window().is_empty() {
        return out;
    }
    for j in 0..height {
        extend_row(grid.row(j), out.row_mut(j + 1));
    }
    let mut border = vec![0.0; width + 2];
    for (from, next, to) in [(1, 2.min(height), 0), (height, (height - 1).max(1), height + 1)] {
        for (i, b) in border.iter_mut().enumerate() {
            *b = beyond(out[(i, from)], out[(i, next)]);
        }
        out.row_mut(to).copy_from_slice(&border);
    }
    out
}

/// Copies `row` to the middle of `out`, which has one more sample at each end, and extrapolates these two.
#[doc(hidden)]
pub fn extend_row(row: &[f32], out: &mut [f32]) {
    let width = row.len();
    out[1..=width].copy_from_slice(row);
    out[0] = beyond(row[0], row[1.min(width - 1)]);
    out[width + 1] = beyond(row[width - 1], row[width.saturating_sub(2)]);
}

/// Linear extrapolation: the value after `last`, where `before` is the value before it.
#[doc(hidden)]
#[must_use]
pub fn beyond(last: f32, before: f32) -> f32 {
    let next = last + (last - before);
    if next.is_finite() { next } else { last }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid of f(east, south), with both coordinates in metres.
    fn grid(window: Window, f: impl Fn(f64, f64) -> f64) -> Grid {
        let mut grid = Grid::filled(window, 0.0);
        for j in 0..window.height {
            for i in 0..window.width {
                grid.row_mut(j)[i] = f(window.east(i), window.south(j)) as f32;
            }
        }
        grid
    }

    #[test]
    fn a_plane_has_its_own_slope_everywhere() {
        for (east, north, cell) in [(0.5, 0.0, 1.0), (0.0, 0.25, 10.24), (-1.5, 2.0, 0.1), (0.0, 0.0, 30.0)] {
            let plane = grid(Window::new(9, 7, cell).at(-4, 3), |x, y| 1000.0 + east * x - north * y);
            let got = from_gradients(&plane, |g| g.east);
            assert_eq!((got.window().x, got.window().y, got.width(), got.height()), (-3, 4, 7, 5));
            let expect = [east, north, (east * east + north * north).sqrt()];
            let values = [got, from_gradients(&plane, |g| g.north), steepness(&plane)];
            for (grid, expect) in values.iter().zip(expect) {
                assert!(grid.data().iter().all(|&v| (f64::from(v) - expect).abs() < 2e-3), "{expect} {cell}");
            }
        }
    }

    #[test]
    fn degrees_of_one_in_one_are_45() {
        let plane = grid(Window::new(4, 4, 2.0), |x, _| x);
        assert!(slope_degrees(&plane).data().iter().all(|&d| (d - 45.0).abs() < 1e-4));
    }

    #[test]
    fn a_tile_is_the_crop() {
        let f = |x: f64, y: f64| (x * 0.37).rem_euclid(7.0) * (y * 0.11).rem_euclid(3.0);
        let all = steepness(&grid(Window::new(40, 30, 5.0), f));
        let tile = steepness(&grid(Window::new(12, 9, 5.0).at(17, 11), f));
        assert_eq!(all.crop(tile.window()).unwrap(), tile);
    }

    #[test]
    fn missing_samples_have_no_slope_and_level_neighbors() {
        let mut grid = grid(Window::new(5, 5, 1.0), |x, _| x);
        grid.row_mut(2)[2] = f32::NAN;
        let steep = steepness(&grid);
        assert!(steep[(1, 1)].is_nan());
        // East of the hole: (c - a) + 2 (f - d) + (i - g) = 2 + 2 (4 - 3) + 2 with the hole level with its neighbor.
        assert!((steep[(2, 1)] - 6.0 / 8.0).abs() < 1e-6);
        grid.row_mut(2)[2] = f32::INFINITY;
        assert!(steepness(&grid)[(1, 1)].is_nan());
        let cliff = Grid::from_data(Window::new(3, 3, 1.0), [f32::MIN, 0.0, f32::MAX].repeat(3)).unwrap();
        assert_eq!(from_gradients(&cliff, |g| g.east).data(), [f32::MAX]);
    }

    #[test]
    fn a_grid_without_an_inside_gives_nothing() {
        for (width, height) in [(0, 0), (2, 9), (9, 2), (1, 1)] {
            assert!(steepness(&Grid::filled(Window::new(width, height, 1.0), 1.0)).window().is_empty());
        }
    }

    #[test]
    fn an_extended_plane_is_the_larger_plane() {
        let f = |x: f64, y: f64| 3.0 * x - 2.0 * y;
        let small = Window::new(6, 4, 0.5);
        assert_eq!(extended(&grid(small, f)), grid(small.grown(1), f));
        let one = Grid::filled(Window::new(1, 1, 1.0), 5.0);
        assert_eq!(extended(&one), Grid::filled(Window::new(1, 1, 1.0).grown(1), 5.0));
        let nothing = extended(&Grid::filled(Window::new(0, 3, 1.0), 5.0));
        assert!(nothing.data().iter().all(|v| v.is_nan()));
    }
}
