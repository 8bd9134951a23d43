//! Values at scattered points, and grids: smooth interpolation, and means around points.

use std::ops::RangeInclusive;

use crate::grid::{Grid, Window};
use crate::parallel;
use crate::polylines::segments::Segments;

/// Distance at which a weight exp(-(d / length)^2) is cut off, in lengths.
const REACH: f64 = 2.5;

/// Maximum number of bins along a side.
const MAX_BINS: f64 = 2048.0;

/// Points in bins, with the weight exp(-(d / length)^2) of a point at the distance d.
pub struct Scattered {
    points: Vec<[f64; 2]>,
    length: f64,
    /// The corner of the first bin, the side of a bin, and the numbers of columns and rows.
    origin: [f64; 2],
    side: f64,
    columns: usize,
    rows: usize,
    /// The first entry of each bin in `members`.
    starts: Vec<usize>,
    members: Vec<u32>,
}

impl Scattered {
    /// Finite points, in metres. `length` must be above 0.
    #[must_use]
    pub fn new(points: &[[f64; 2]], length: f64) -> Scattered {
        let bound = |k: usize, of: fn(f64, f64) -> f64| points.iter().map(|at| at[k]).reduce(of).unwrap_or(0.0);
        let origin = [bound(0, f64::min), bound(1, f64::min)];
        let extent = [bound(0, f64::max) - origin[0], bound(1, f64::max) - origin[1]];
        let side = (REACH * length).max(extent[0].max(extent[1]) / MAX_BINS);
        let [columns, rows] = extent.map(|length| (length / side) as usize + 1);
        let mut made = Scattered {
            points: points.to_vec(),
            length,
            origin,
            side,
            columns,
            rows,
            starts: vec![0; columns * rows + 1],
            members: vec![0; points.len()],
        };
        let bins: Vec<usize> = points.iter().map(|at| made.bin(*at)).collect();
        bins.iter().for_each(|bin| made.starts[bin + 1] += 1);
        for bin in 0..columns * rows {
            made.starts[bin + 1] += made.starts[bin];
        }
        let mut next = made.starts.clone();
        for (point, bin) in (0u32..).zip(bins) {
            made.members[next[bin]] = point;
            next[bin] += 1;
        }
        made
    }

    /// The column and the row of a position, limited to the bins.
    fn place(&self, [x, y]: [f64; 2]) -> [usize; 2] {
        let index = |at: f64, origin: f64, count: usize| (((at - origin) / self.side).max(0.0) as usize).min(count - 1);
        [index(x, self.origin[0], self.columns), index(y, self.origin[1], self.rows)]
    }

    fn bin(&self, at: [f64; 2]) -> usize {
        let [column, row] = self.place(at);
        row * self.columns + column
    }

    /// The weighted mean of the values at the points around a position; NaN if there is none.
    fn mean(&self, values: &[f64], [x, y]: [f64; 2]) -> f64 {
        let [column, row] = self.place([x, y]);
        let limit = (REACH * self.length) * (REACH * self.length);
        let (mut weights, mut sum) = (0.0, 0.0);
        for row in row.saturating_sub(1)..(row + 2).min(self.rows) {
            let first = row * self.columns;
            let (from, to) = (first + column.saturating_sub(1), first + (column + 2).min(self.columns));
            for &point in &self.members[self.starts[from]..self.starts[to]] {
                let [px, py] = self.points[point as usize];
                let square = (px - x) * (px - x) + (py - y) * (py - y);
                if square < limit {
                    let weight = libm::exp(-square / (self.length * self.length));
                    weights += weight;
                    sum += weight * values[point as usize];
                }
            }
        }
        sum / weights
    }

    /// Values at the points as a smooth surface: the weighted means around each sample, then `corrections` times the
    /// weighted means of what the surface lacks at the points (successive corrections; Barnes 1964). Samples without
    /// points around them are NaN.
    #[must_use]
    pub fn interpolated(&self, values: &[f64], window: &Window, corrections: usize) -> Grid {
        let mut grid = Grid::filled(*window, 0.0);
        let mut rest = values.to_vec();
        for correction in 0..=corrections {
            self.add(&rest, &mut grid);
            if correction < corrections {
                let made = parallel::samples(rest.len(), |k| self.mean(&rest, self.points[k]));
                rest.iter_mut().zip(made).for_each(|(rest, made)| *rest -= made);
            }
        }
        grid
    }

    fn add(&self, values: &[f64], grid: &mut Grid) {
        let window = *grid.window();
        let width = window.width.max(1);
        parallel::for_each(grid.data_mut().chunks_mut(width).enumerate(), |(j, row)| {
            let y = window.south(j);
            for (i, sample) in row.iter_mut().enumerate() {
                *sample += self.mean(values, [window.east(i), y]) as f32;
            }
        });
    }
}

/// The means of the samples above `floor` around points, with the weight exp(-(d / length)^2) of a sample at the
/// distance d. NaN where less than a quarter of the weight is above it.
#[must_use]
pub fn means_above(grid: &Grid, floor: f32, points: &[[f64; 2]], length: f64) -> Vec<f64> {
    let window = grid.window();
    let reach = REACH * length;
    let range = |at: f64, first: i64, count: usize| {
        let index = |metres: f64| (metres / window.cell).clamp(-1e15, 1e15);
        let from = (index(at - reach).ceil() as i64 - first).clamp(0, count as i64) as usize;
        from..((index(at + reach).floor() as i64 - first + 1).clamp(from as i64, count as i64) as usize)
    };
    parallel::samples(points.len(), |k| {
        let [x, y] = points[k];
        let (mut all, mut above, mut sum) = (0.0, 0.0, 0.0);
        for j in range(y, window.y, window.height) {
            let south = window.south(j) - y;
            for i in range(x, window.x, window.width) {
                let east = window.east(i) - x;
                let weight = libm::exp(-(east * east + south * south) / (length * length));
                let value = grid[(i, j)];
                all += weight;
                if value > floor {
                    above += weight;
                    sum += weight * f64::from(value);
                }
            }
        }
        if above > 0.25 * all { sum / above } else { f64::NAN }
    })
}

/// The samples of one grid inside of rings and of the other outside, each limited to its range. The grids have the same
/// window.
#[must_use]
pub fn chosen(
    rings: &Segments,
    (inside, inner): (&Grid, RangeInclusive<f32>),
    (outside, outer): (&Grid, RangeInclusive<f32>),
) -> Grid {
    let window = *inside.window();
    let mut grid = inside.clone();
    let width = window.width.max(1);
    parallel::for_each(grid.data_mut().chunks_mut(width).enumerate(), |(j, row)| {
        for (i, sample) in row.iter_mut().enumerate() {
            *sample = match rings.is_inside([window.east(i), window.south(j)]) {
                true => sample.clamp(*inner.start(), *inner.end()),
                false => outside[(i, j)].clamp(*outer.start(), *outer.end()),
            };
        }
    });
    grid
}

/// A grid multiplied by the exponentials of another, where that has values, within a range.
#[must_use]
pub fn multiplied(grid: &Grid, logarithms: &Grid, range: RangeInclusive<f32>) -> Grid {
    let mut made = grid.clone();
    for (sample, logarithm) in made.data_mut().iter_mut().zip(logarithms.data()) {
        if logarithm.is_finite() {
            let factor = libm::exp(f64::from(*logarithm)) as f32;
            *sample = (*sample * factor).clamp(*range.start(), *range.end());
        }
    }
    made
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    /// 400 points in a square of 2 km, and a smooth surface at them.
    fn points() -> (Vec<[f64; 2]>, Vec<f64>) {
        let mut random = Random::of_state(5);
        let mut share = || (random.draw() >> 11) as f64 / (1u64 << 53) as f64;
        let jittered = |k: usize, share: f64| 100.0 * (k as f64 + 0.2 + 0.6 * share);
        let points: Vec<[f64; 2]> = (0..400).map(|k| [jittered(k % 20, share()), jittered(k / 20, share())]).collect();
        let values = points.iter().map(|at| surface(*at)).collect();
        (points, values)
    }

    fn surface([x, y]: [f64; 2]) -> f64 {
        300.0 + 200.0 * libm::sin(x / 300.0) * libm::cos(y / 400.0)
    }

    #[test]
    fn a_smooth_surface_is_found_again() {
        let (points, values) = points();
        let window = Window::new(32, 32, 50.0).at(4, 4);
        let error = |corrections| {
            let grid = Scattered::new(&points, 80.0).interpolated(&values, &window, corrections);
            let errors = (0..32 * 32).map(|k| {
                let (i, j) = (k % 32, k / 32);
                f64::from(grid[(i, j)]) - surface([window.east(i), window.south(j)])
            });
            (errors.map(|error| error * error).sum::<f64>() / 1024.0).sqrt()
        };
        assert!(error(2) < 4.0 && error(0) > 2.0 * error(2), "{} {}", error(0), error(2));
    }

    #[test]
    fn samples_do_not_depend_on_the_window_and_are_missing_far_from_points() {
        let (points, values) = points();
        let scattered = Scattered::new(&points, 80.0);
        let whole = scattered.interpolated(&values, &Window::new(40, 40, 50.0), 1);
        let part = Window::new(7, 9, 50.0).at(11, 5);
        assert_eq!(whole.crop(&part).unwrap(), scattered.interpolated(&values, &part, 1));
        let far = scattered.interpolated(&values, &Window::new(2, 2, 50.0).at(-200, 900), 1);
        assert!(far.data().iter().all(|sample| sample.is_nan()));
        let none = Scattered::new(&[], 80.0).interpolated(&[], &part, 1);
        assert!(none.data().iter().all(|sample| sample.is_nan()));
    }

    #[test]
    fn means_leave_out_what_is_below() {
        let window = Window::new(40, 40, 10.0);
        let data = (0..1600).map(|k| if k % 40 < 20 { 100.0 } else { -50.0 }).collect();
        let grid = Grid::from_data(window, data).unwrap();
        let means = means_above(&grid, 0.0, &[[100.0, 200.0], [195.0, 200.0], [350.0, 200.0], [-1e12, 1e12]], 30.0);
        assert_eq!(means[..2].iter().map(|mean| mean.round()).collect::<Vec<_>>(), [100.0, 100.0]);
        assert!(means[2..].iter().all(|mean| mean.is_nan()));
    }
}
