//! Interpolation of grids.

use crate::grid::Grid;
use orogen_noise::Points;
use serde::{Deserialize, Serialize};

/// How a layer is interpolated between its samples. At the position of a sample the value is that sample, bit for bit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum LayerKind {
    /// Smooth values, such as heights: interpolating cubic (Catmull and Rom 1974).
    Height,
    /// Numbers that are names, such as those of watersheds: nearest sample.
    Label,
    /// Values over many orders of magnitude, such as drainage areas: linear in their logarithms, within the range of
    /// the surrounding samples. Nearest sample if one of these is not positive.
    Flow,
}

impl LayerKind {
    /// The name in the declaration of a layer.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            LayerKind::Height => "height",
            LayerKind::Label => "label",
            LayerKind::Flow => "flow",
        }
    }

    /// The description in the reference documentation.
    #[must_use]
    pub fn about(self) -> &'static str {
        match self {
            LayerKind::Height => "cubic interpolation",
            LayerKind::Label => "nearest sample",
            LayerKind::Flow => "interpolation of logarithms",
        }
    }
}

/// The position of a missing point. Plans provide all points; this only prevents a panic in case of a bug.
pub const NOWHERE: (f64, f64) = (f64::NAN, f64::NAN);

/// Index of the sample at or before a position, and the fraction to the next one.
///
/// A position exactly at a lattice point (index * cell gives the same f64) has fraction 0 at that index, even if the
/// division is rounded, as with cells such as 10.24, 0.1 and 1/3.
#[must_use]
pub fn split(position: f64, cell: f64) -> (i64, f32) {
    let steps = position / cell;
    // Beyond this limit every f64 is an integer. Values beyond i64 saturate.
    const WHOLE: f64 = (1u64 << 52) as f64;
    if !(-WHOLE..=WHOLE).contains(&steps) {
        return (steps as i64, 0.0);
    }
    // Rounding through an integer: without SSE4.1, `floor` and `round` are function calls.
    let cut = steps as i64;
    let index = if (cut as f64) > steps { cut - 1 } else { cut };
    let rest = steps - index as f64;
    let nearest = if rest < 0.5 { index } else { index + 1 };
    if nearest as f64 * cell == position {
        return (nearest, 0.0);
    }
    let share = rest as f32;
    // Rounding to f32 can give 1, which means the next sample.
    if share >= 1.0 { (index + 1, 0.0) } else { (index, share) }
}

/// Moves every sample by a share of the way to that of another grid over the same window: at 0 it stays, at 1 it is the
/// other one, except for rounding.
// Never in the caller's crate, which may be compiled without optimization.
#[inline(never)]
pub fn blend(grid: &mut Grid, other: &Grid, share: f32) {
    let pairs = grid.data_mut().iter_mut().zip(other.data());
    pairs.for_each(|(sample, other)| *sample += share * (other - *sample));
}

/// Number of columns of a lattice that are processed together.
const COLUMNS: usize = 256;

/// Interpolates `grid` at all points into `out`, according to the [`LayerKind`].
///
/// Outside the grid, the samples at its border are repeated. A point that is not finite gives NaN.
pub fn read(grid: &Grid, kind: LayerKind, at: &Points, out: &mut [f32]) {
    let reader = Reader::new(grid);
    match (kind, at) {
        (LayerKind::Height, Points::Lattice { xs, ys }) if !xs.is_empty() => {
            let mut columns = [(0, 0.0); COLUMNS];
            for (c, part) in xs.chunks(COLUMNS).enumerate() {
                for (column, x) in columns.iter_mut().zip(part) {
                    *column = split(*x, grid.window().cell);
                }
                let columns = &columns[..part.len()];
                let first = first_sample(part, columns);
                for (row, y) in out.chunks_mut(xs.len()).zip(ys.iter()) {
                    let (j, v) = split(*y, grid.window().cell);
                    let row = &mut row[c * COLUMNS..][..part.len()];
                    if let Some(i) = first
                        && v == 0.0
                        && y.is_finite()
                    {
                        reader.copy(i, j, row);
                        continue;
                    }
                    for (sample, (x, (i, u))) in row.iter_mut().zip(part.iter().zip(columns)) {
                        *sample = if x.is_finite() && y.is_finite() { reader.cubic(*i, j, *u, v) } else { f32::NAN };
                    }
                }
            }
        }
        (_, Points::Displaced { xs, ys, dx, dy }) if !xs.is_empty() => {
            let width = xs.len();
            let moved = dx.chunks(width).zip(dy.chunks(width));
            for ((row, y), (dx, dy)) in out.chunks_mut(width).zip(ys.iter()).zip(moved) {
                for ((sample, x), (dx, dy)) in row.iter_mut().zip(xs.iter()).zip(dx.iter().zip(dy)) {
                    *sample = reader.at(kind, x + f64::from(*dx), y + f64::from(*dy));
                }
            }
        }
        _ => {
            for (k, sample) in out.iter_mut().enumerate() {
                let (x, y) = at.position(k).unwrap_or(NOWHERE);
                *sample = reader.at(kind, x, y);
            }
        }
    }
}

/// The first index of columns that are at consecutive samples, so that rows of them can be copied.
fn first_sample(xs: &[f64], columns: &[(i64, f32)]) -> Option<i64> {
    let (first, _) = *columns.first()?;
    let is_next = |(k, (x, (i, u))): (usize, (&f64, &(i64, f32)))| {
        x.is_finite() && *u == 0.0 && i.checked_sub(first) == Some(k as i64)
    };
    xs.iter().zip(columns).enumerate().all(is_next).then_some(first)
}

/// Index of the nearest sample; halves are rounded up to the next sample.
fn nearest(position: f64, cell: f64) -> i64 {
    let (index, share) = split(position, cell);
    if share >= 0.5 { index + 1 } else { index }
}

struct Reader<'a> {
    data: &'a [f32],
    x: i64,
    y: i64,
    width: i64,
    height: i64,
    cell: f64,
}

impl Reader<'_> {
    fn new(grid: &Grid) -> Reader<'_> {
        let window = grid.window();
        Reader {
            data: grid.data(),
            x: window.x,
            y: window.y,
            width: window.width as i64,
            height: window.height as i64,
            cell: window.cell,
        }
    }

    fn sample(&self, i: i64, j: i64) -> f32 {
        let i = i.saturating_sub(self.x).clamp(0, self.width - 1);
        let j = j.saturating_sub(self.y).clamp(0, self.height - 1);
        self.data.get((j * self.width + i) as usize).copied().unwrap_or(f32::NAN)
    }

    /// Consecutive samples of a row.
    fn copy(&self, i: i64, j: i64, out: &mut [f32]) {
        let start = (j.saturating_sub(self.y).clamp(0, self.height - 1) * self.width) as usize;
        let row = self.data.get(start..start + self.width as usize);
        let from = usize::try_from(i.saturating_sub(self.x)).ok();
        match row.zip(from).and_then(|(row, from)| row.get(from..from.checked_add(out.len())?)) {
            Some(inside) => out.copy_from_slice(inside),
            None => {
                for (k, sample) in out.iter_mut().enumerate() {
                    *sample = self.sample(i.saturating_add(k as i64), j);
                }
            }
        }
    }

    fn at(&self, kind: LayerKind, x: f64, y: f64) -> f32 {
        if !(x.is_finite() && y.is_finite()) {
            return f32::NAN;
        }
        let label = || self.sample(nearest(x, self.cell), nearest(y, self.cell));
        if kind == LayerKind::Label {
            return label();
        }
        let ((i, u), (j, v)) = (split(x, self.cell), split(y, self.cell));
        match kind {
            LayerKind::Flow => self.logarithmic(i, j, u, v).unwrap_or_else(label),
            _ => self.cubic(i, j, u, v),
        }
    }

    /// Linear in the logarithms of the four surrounding samples; `None` if one is not positive. Fraction 0 gives the
    /// sample itself.
    fn logarithmic(&self, i: i64, j: i64, u: f32, v: f32) -> Option<f32> {
        if u == 0.0 && v == 0.0 {
            return Some(self.sample(i, j));
        }
        let log = |di: i64, dj: i64| {
            let sample = self.sample(i.saturating_add(di), j.saturating_add(dj));
            (sample > 0.0 && sample.is_finite()).then(|| libm::log(f64::from(sample)))
        };
        let (u, v) = (f64::from(u), f64::from(v));
        let (north, south) = (
            log(0, 0)? * (1.0 - u) + if u > 0.0 { log(1, 0)? * u } else { 0.0 },
            if v > 0.0 { log(0, 1)? * (1.0 - u) + if u > 0.0 { log(1, 1)? * u } else { 0.0 } } else { 0.0 },
        );
        Some(libm::exp(north * (1.0 - v) + south * v) as f32)
    }

    /// The surrounding 4 x 4 samples if all of them are inside the grid. This is the common case and needs no border
    /// checks.
    fn inner(&self, i: i64, j: i64) -> Option<[[f32; 4]; 4]> {
        let (left, top) = (i.saturating_sub(self.x).saturating_sub(1), j.saturating_sub(self.y).saturating_sub(1));
        if left < 0 || top < 0 || left > self.width - 4 || top > self.height - 4 {
            return None;
        }
        let (left, top, width) = (left as usize, top as usize, self.width as usize);
        let mut rows = [[0.0; 4]; 4];
        for (j, row) in rows.iter_mut().enumerate() {
            let from = (top + j) * width + left;
            row.copy_from_slice(self.data.get(from..from + 4)?);
        }
        Some(rows)
    }

    /// The cubic of Catmull and Rom (1974), along x in four rows, then along y. Fraction 0 gives the sample itself, bit
    /// for bit.
    fn cubic(&self, i: i64, j: i64, u: f32, v: f32) -> f32 {
        if u != 0.0
            && v != 0.0
            && let Some(rows) = self.inner(i, j)
        {
            return catmull_rom(rows.map(|row| catmull_rom(row, u)), v);
        }
        let along = |j: i64| {
            if u == 0.0 {
                return self.sample(i, j);
            }
            let taps = [-1, 0, 1, 2].map(|step| self.sample(i.saturating_add(step), j));
            catmull_rom(taps, u)
        };
        if v == 0.0 {
            return along(j);
        }
        catmull_rom([-1, 0, 1, 2].map(|step| along(j.saturating_add(step))), v)
    }
}

/// The polynomial through four samples, at the fraction `t` between the second and the third.
#[inline]
fn catmull_rom([p0, p1, p2, p3]: [f32; 4], t: f32) -> f32 {
    p1 + 0.5 * t * ((p2 - p0) + t * ((2.0 * p0 - 5.0 * p1 + 4.0 * p2 - p3) + t * (3.0 * (p1 - p2) + p3 - p0)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Window;

    #[test]
    fn lattice_points_are_exact() {
        for cell in [10.24, 0.1, 1.0 / 3.0, 30.0, 1e-3] {
            for index in [0i64, 1, -1, 3, 7, 1023, -999_983, 123_456_789] {
                assert_eq!(split(index as f64 * cell, cell), (index, 0.0), "{index} * {cell}");
            }
        }
    }

    #[test]
    fn shares_stay_below_one() {
        let (index, share) = split(1.0 - 1e-12, 1.0);
        assert_eq!((index, share), (1, 0.0));
        assert_eq!(split(-0.25, 1.0), (-1, 0.75));
    }

    #[test]
    fn blended_samples_lie_between_both() {
        let grid = |samples: [f32; 3]| Grid::from_data(Window::new(3, 1, 1.0), samples.to_vec()).unwrap();
        for (share, expect) in [(0.0, [0.0, 8.0, -4.0]), (0.25, [1.0, 8.0, -2.0]), (1.0, [4.0, 8.0, 4.0])] {
            let mut blended = grid([0.0, 8.0, -4.0]);
            blend(&mut blended, &grid([4.0, 8.0, 4.0]), share);
            assert_eq!(blended, grid(expect), "{share}");
        }
    }

    #[test]
    fn reads_samples_and_lines() {
        let window = Window::new(6, 5, 10.0).at(-2, 3);
        let mut grid = Grid::filled(window, 0.0f32);
        for j in 0..5 {
            for i in 0..6 {
                grid.row_mut(j)[i] = (2.0 * window.east(i) + window.south(j)) as f32;
            }
        }
        let xs = [-20.0, -3.0, 11.5];
        let ys = [40.0, 47.0];
        let mut out = [0.0; 6];
        read(&grid, LayerKind::Height, &Points::Lattice { xs: &xs, ys: &ys }, &mut out);
        assert_eq!(out[0], 0.0, "a sample itself");
        // A cubic reproduces straight lines in the interior; near the border the border sample is repeated.
        assert!((out[1] - 34.0).abs() < 1e-4 && (out[4] - 41.0).abs() < 1e-4, "{out:?}");
        let x = [-20.0, -3.0, 11.5, -20.0, -3.0, 11.5];
        let y = [40.0, 40.0, 40.0, 47.0, 47.0, 47.0];
        let mut again = [0.0; 6];
        read(&grid, LayerKind::Height, &Points::Scattered { x: &x, y: &y }, &mut again);
        assert_eq!(out, again);
        let mut far = [0.0; 2];
        let wild = Points::Scattered { x: &[f64::NAN, 1e300], y: &[0.0, -1e300] };
        read(&grid, LayerKind::Height, &wild, &mut far);
        assert!(far[0].is_nan() && far[1].is_finite());
    }

    #[test]
    fn rows_of_samples_are_copied_also_across_the_border() {
        let window = Window::new(300, 4, 0.1).at(-7, 2);
        let data = (0..window.len()).map(|k| (k * k % 977) as f32).collect();
        let grid = Grid::from_data(window, data).unwrap();
        for (first, count) in [(-7, 300), (-20, 320), (0, 257), (290, 30), (400, 3), (-60, 5)] {
            let xs: Vec<f64> = (first..first + count).map(|i| i as f64 * 0.1).collect();
            let ys: Vec<f64> = (0..9).map(|j| f64::from(j) * 0.1).chain([f64::NAN, 0.55]).collect();
            let lattice = Points::Lattice { xs: &xs, ys: &ys };
            let (x, y): (Vec<f64>, Vec<f64>) = (0..lattice.len()).map(|k| lattice.position(k).unwrap()).unzip();
            let (mut rows, mut points) = (vec![0.0; lattice.len()], vec![0.0; lattice.len()]);
            read(&grid, LayerKind::Height, &lattice, &mut rows);
            read(&grid, LayerKind::Height, &Points::Scattered { x: &x, y: &y }, &mut points);
            let bits = |samples: &[f32]| samples.iter().map(|sample| sample.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(&rows), bits(&points), "{first}, {count}");
        }
    }

    #[test]
    fn labels_and_flows_are_not_mixed_like_heights() {
        let window = Window::new(3, 3, 1.0);
        let grid = Grid::from_data(window, vec![1.0, 100.0, 1e4, 1.0, 100.0, 1e4, 0.0, 7.0, 7.0]).unwrap();
        let (x, y) = ([0.0, 0.5, 0.25, 1.5, 0.25, 0.5], [0.0, 0.0, 0.5, 1.0, 1.75, 2.0]);
        let mut out = [0.0; 6];
        read(&grid, LayerKind::Label, &Points::Scattered { x: &x, y: &y }, &mut out);
        assert_eq!(out, [1.0, 100.0, 1.0, 1e4, 0.0, 7.0]);
        read(&grid, LayerKind::Flow, &Points::Scattered { x: &x, y: &y }, &mut out);
        let expect = [1.0, 10.0, 3.162_277_7, 1000.0, 0.0, 7.0];
        for (made, expect) in out.iter().zip(expect) {
            assert!((made - expect).abs() <= 1e-5 * expect, "{out:?}");
        }
    }
}
