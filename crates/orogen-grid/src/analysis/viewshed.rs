//! Viewsheds: the ground that is visible from a point.

use crate::parallel;

use crate::error::Result;
use crate::grid::{Grid, transposed};

/// Checks for cancellation; returns an error if the work was cancelled.
pub type Check<'a> = &'a (dyn Fn() -> Result<()> + Sync);

/// The observer and the range of sight.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Observer {
    /// Position: columns east and rows south of the grid's first sample.
    pub at: [f64; 2],
    /// Height of the eye above the ground, in metres.
    pub height: f64,
    /// Range of sight, in metres.
    pub radius: f64,
    /// Drop of the ground below the tangent plane at a distance of one metre, in metres; it grows with the square of
    /// the distance. 0 for a plane.
    pub sinking: f64,
}

impl Observer {
    /// An observer with an eye `height` metres above the ground, on a plane, with unlimited range of sight.
    #[must_use]
    pub const fn new(at: [f64; 2], height: f64) -> Observer {
        Observer { at, height, radius: f64::INFINITY, sinking: 0.0 }
    }
}

orogen_noise::builder!(
    Observer:
    with_at(at: [f64; 2]),
    with_height(height: f64),
    with_radius(radius: f64),
    with_sinking(sinking: f64)
);

/// The earth's mean radius in metres.
const EARTH: f64 = 6_371_008.8;

/// [`Observer::sinking`] for the earth's curvature and a refraction coefficient (usually 0.13 for light).
#[must_use]
pub fn sinking(refraction: f64) -> f64 {
    (1.0 - refraction) / (2.0 * EARTH)
}

/// The value of [`viewshed`] beyond the observer's radius.
pub const BEYOND: f32 = -1.0;

/// The height, in metres above the ground of each sample, from which the observer is visible. It is 0 where the ground
/// itself is visible, and [`BEYOND`] beyond the radius.
///
/// The lines of sight from the eye to every sample are exact (R3; Franklin and Ray, "Higher isn't necessarily better:
/// visibility algorithms and experiments", 1994): the ground is interpolated linearly wherever a line crosses a column
/// (or a row, if it crosses more rows than columns). Squares whose maximum cannot rise above the current horizon are
/// skipped, which does not change the result. There is no ground outside the grid: an observer there stands as high as
/// the nearest sample. Needs 15 bytes per sample. Rows are computed in parallel.
///
/// # Errors
/// The error of `check`, which is called regularly.
pub fn viewshed(heights: &Grid, observer: &Observer, check: Check) -> Result<Grid> {
    let (window, [x, y]) = (*heights.window(), observer.at);
    let mut out = Grid::filled(window, BEYOND);
    if window.is_empty() {
        return Ok(out);
    }
    let ground = MaxPyramid::new(heights.data().to_vec(), window.width);
    check()?;
    let turned = MaxPyramid::new(transposed(heights.data(), window.width), window.height);
    check()?;
    let eye = ground.at(x, y) + observer.height;
    parallel::try_for_each(out.data_mut().chunks_mut(window.width).enumerate(), |(j, row)| {
        check()?;
        for (i, out) in row.iter_mut().enumerate() {
            let (east, south) = (i as f64 - x, j as f64 - y);
            let way = (east * east + south * south).sqrt() * window.cell;
            if way > observer.radius {
                continue;
            }
            let sight = |from, to| Sight { from, to, eye, cell: window.cell, sinking: observer.sinking };
            let steepest = match east.abs() >= south.abs() {
                true => sight([x, y], [i as i64, j as i64]).steepest(&ground),
                false => sight([y, x], [j as i64, i as i64]).steepest(&turned),
            };
            let here = f64::from(heights[(i, j)]);
            *out = (eye + steepest * way + observer.sinking * way * way - here).max(0.0) as f32;
        }
        Ok(())
    })?;
    Ok(out)
}

/// Heights, and the maxima of squares with sides of 2, 4, 8 ... samples.
struct MaxPyramid {
    levels: Vec<Level>,
}

struct Level {
    samples: Vec<f32>,
    columns: usize,
    rows: usize,
}

impl MaxPyramid {
    fn new(samples: Vec<f32>, columns: usize) -> MaxPyramid {
        let rows = samples.len() / columns;
        let mut levels = vec![Level { samples, columns, rows }];
        while let Some(below) = levels.last().filter(|below| below.columns > 1 || below.rows > 1) {
            let (columns, rows) = (below.columns.div_ceil(2), below.rows.div_ceil(2));
            let mut samples = vec![f32::NEG_INFINITY; columns * rows];
            for (j, row) in below.samples.chunks_exact(below.columns).enumerate() {
                for (i, height) in row.iter().enumerate() {
                    let highest = &mut samples[j / 2 * columns + i / 2];
                    *highest = highest.max(*height);
                }
            }
            levels.push(Level { samples, columns, rows });
        }
        MaxPyramid { levels }
    }

    /// The height at a point, linear between rows and columns. Outside the grid, the height at its edge.
    fn at(&self, x: f64, y: f64) -> f64 {
        let ground = &self.levels[0];
        let x = x.clamp(0.0, (ground.columns - 1) as f64);
        let i = (x as usize).min(ground.columns.saturating_sub(2));
        let (west, share) = (self.across(i, y), x - i as f64);
        if share == 0.0 { west } else { west + (self.across(i + 1, y) - west) * share }
    }

    /// The height at `y` in column `i`.
    fn across(&self, i: usize, y: f64) -> f64 {
        let ground = &self.levels[0];
        let y = y.clamp(0.0, (ground.rows - 1) as f64);
        let j = (y as usize).min(ground.rows.saturating_sub(2));
        let north = f64::from(ground.samples[j * ground.columns + i]);
        let south = f64::from(ground.samples[(j + 1).min(ground.rows - 1) * ground.columns + i]);
        north + (south - north) * (y - j as f64)
    }

    /// The maximum of a column of squares with a side of 2^k samples, over all rows between `top` and `bottom`.
    fn highest(&self, k: usize, column: usize, top: f64, bottom: f64) -> f64 {
        let level = &self.levels[k];
        let row = |y: f64| ((y.max(0.0) as usize) >> k).min(level.rows - 1);
        let rows = row(top)..=row(bottom + 1.0);
        f64::from(rows.map(|j| level.samples[j * level.columns + column]).fold(f32::NEG_INFINITY, f32::max))
    }
}

/// A line of sight that crosses more columns than rows.
struct Sight {
    from: [f64; 2],
    to: [i64; 2],
    eye: f64,
    cell: f64,
    sinking: f64,
}

impl Sight {
    /// The steepest slope from the eye to the ground before the target; negative infinity if there is none.
    fn steepest(&self, ground: &MaxPyramid) -> f64 {
        let [x, y] = self.from;
        let (across, down) = (self.to[0] as f64 - x, self.to[1] as f64 - y);
        let mut steepest = f64::NEG_INFINITY;
        if across == 0.0 {
            return steepest;
        }
        let slant = down / across;
        let metres = (1.0 + slant * slant).sqrt() * self.cell;
        let forwards = across > 0.0;
        let entry = self.entry(slant, ground);
        // The first crossed column, and the last one before the target.
        let (first, last) = match forwards {
            true => ((x.floor() as i64).saturating_add(1).max(entry.ceil() as i64), self.to[0] - 1),
            false => ((x.ceil() as i64).saturating_sub(1).min(entry.floor() as i64), self.to[0] + 1),
        };
        let left = |column: i64| if forwards { last - column + 1 } else { column - last + 1 };
        let (mut column, mut try_level) = (first, 0usize);
        while left(column) > 0 {
            // The largest square that starts at this column and ends before the target.
            let aligned = if forwards { column } else { column + 1 };
            let most = (aligned.trailing_zeros() as usize).min(left(column).ilog2() as usize);
            let k = try_level.min(most).min(ground.levels.len() - 1);
            let step = 1i64 << k;
            let end = if forwards { column + step - 1 } else { column - step + 1 };
            if k == 0 {
                let away = (column as f64 - x).abs();
                let rise = self.rise(ground.across(column as usize, y + slant * (column as f64 - x)), away * metres);
                steepest = steepest.max(rise);
            } else {
                let (near, far) = ((column as f64 - x).abs() * metres, (end as f64 - x).abs() * metres);
                let (one, other) = (y + slant * (column as f64 - x), y + slant * (end as f64 - x));
                let highest = ground.highest(k, (column.min(end) >> k) as usize, one.min(other), one.max(other));
                let above = highest - self.sinking * near * near - self.eye;
                if above / if above >= 0.0 { near } else { far } > steepest {
                    try_level = k - 1;
                    continue;
                }
            }
            try_level = k + 1;
            column = if forwards { end + 1 } else { end - 1 };
        }
        steepest
    }

    /// The x at which a line of sight from outside the grid enters it; the eye's x if the eye is inside. Nothing
    /// outside the grid hides anything.
    fn entry(&self, slant: f64, ground: &MaxPyramid) -> f64 {
        let [x, y] = self.from;
        let [right, bottom] = [ground.levels[0].columns, ground.levels[0].rows].map(|samples| (samples - 1) as f64);
        let nearest = y.clamp(0.0, bottom);
        // A line of sight along the rows never enters from the north or the south.
        let entered = if nearest == y { x } else { x + (nearest - y) / slant };
        if self.to[0] as f64 > x { entered.max(0.0) } else { entered.min(right) }
    }

    /// The slope from the eye to ground at `height` at the distance `away`.
    fn rise(&self, height: f64, away: f64) -> f64 {
        (height - self.sinking * away * away - self.eye) / away
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Window;

    fn ground(columns: usize, rows: usize) -> Grid {
        let height =
            |x: f64, y: f64| 90.0 * libm::sin(x * 0.21) * libm::cos(y * 0.17) + 25.0 * libm::sin(x * 0.83 + y * 0.61);
        let data = (0..columns * rows).map(|k| height((k % columns) as f64, (k / columns) as f64) as f32).collect();
        Grid::from_data(Window::new(columns, rows, 20.0), data).unwrap()
    }

    #[test]
    fn skipping_changes_nothing() {
        for ((columns, rows), at) in
            [((61, 47), [20.0, 30.0]), ((40, 64), [0.3, 63.0]), ((33, 32), [32.0, 7.6]), ((5, 1), [1.0, 0.0])]
        {
            let heights = ground(columns, rows);
            for sinking in [0.0, sinking(0.13), 1e-4] {
                let observer = Observer { at, height: 3.0, radius: 1e9, sinking };
                let found = viewshed(&heights, &observer, &|| Ok(())).unwrap();
                let plain = MaxPyramid::new(heights.data().to_vec(), columns);
                let eye = plain.at(at[0], at[1]) + 3.0;
                for (k, found) in found.data().iter().enumerate() {
                    let (i, j) = ((k % columns) as f64, (k / columns) as f64);
                    let [dx, dy] = [i - at[0], j - at[1]];
                    let (long, way) = (dx.abs().max(dy.abs()), (dx * dx + dy * dy).sqrt() * 20.0);
                    let mut steepest = f64::NEG_INFINITY;
                    for line in 0..columns.max(rows) {
                        // Where the line of sight crosses this column or row.
                        let share =
                            if dx.abs() >= dy.abs() { (line as f64 - at[0]) / dx } else { (line as f64 - at[1]) / dy };
                        if long > 0.0 && share > 0.0 && share < 1.0 - 1e-9 {
                            let there = plain.at(at[0] + share * dx, at[1] + share * dy);
                            let away = share * way;
                            steepest = steepest.max((there - sinking * away * away - eye) / away);
                        }
                    }
                    let here = f64::from(heights.data()[k]);
                    let expect =
                        if way == 0.0 { 0.0 } else { (eye + steepest * way + sinking * way * way - here).max(0.0) };
                    let expect = if steepest == f64::NEG_INFINITY { 0.0 } else { expect };
                    assert!((f64::from(*found) - expect).abs() < 1e-3, "({i}, {j}) from {at:?}: {found} {expect}");
                }
            }
        }
    }

    #[test]
    fn from_outside_only_the_ground_of_the_grid_hides() {
        let mut heights = Grid::filled(Window::new(50, 21, 10.0), 0.0f32);
        (0..21).for_each(|j| heights.row_mut(j)[20] = 12.0);
        for (at, shown, behind, hidden_to) in [
            // The eye is 300 m from the wall and 10 m below its top. At 500 m the ground is 16.7 m below the line of
            // sight.
            ([-10.0, 10.0], (15, 10), (40, 10), 2.0 + 10.0 / 300.0 * 500.0),
            ([70.0, 10.0], (25, 10), (10, 10), 2.0 + 10.0 / 500.0 * 600.0),
            // North of the grid: the line of sight crosses the line of the wall outside the grid, or just at its end.
            ([20.0, -30.0], (22, 10), (40, 10), 0.0),
            ([0.0, -10.0], (19, 10), (40, 10), 2.0 + 10.0 / 20.0 * 40.0),
        ] {
            let found = viewshed(&heights, &Observer::new(at, 2.0), &|| Ok(())).unwrap();
            assert_eq!(found[shown], 0.0, "{at:?}");
            assert!((f64::from(found[behind]) - hidden_to).abs() < 1e-3, "{at:?}: {}, not {hidden_to}", found[behind]);
        }
        // The farthest positions that recipes accept, in any direction.
        for at in [[-1e13, -1e13], [1e13, 4.0], [7.5, -1e13], [1e13, 0.0]] {
            assert!(
                viewshed(&heights, &Observer::new(at, 2.0), &|| Ok(())).unwrap().data().iter().all(|h| h.is_finite())
            );
        }
    }

    #[test]
    fn a_wall_hides_what_its_shadow_would() {
        let mut heights = Grid::filled(Window::new(50, 21, 10.0), 0.0f32);
        (0..21).for_each(|j| heights.row_mut(j)[20] = 12.0);
        let observer = Observer { at: [10.0, 10.0], height: 2.0, radius: 350.0, sinking: 0.0 };
        let found = viewshed(&heights, &observer, &|| Ok(())).unwrap();
        // From a height of 2 m, over the top of a wall 100 m away and 10 m higher: 32 m at a distance of 300 m.
        assert!((found[(40, 10)] - 32.0).abs() < 1e-3, "{}", found[(40, 10)]);
        assert_eq!([found[(15, 10)], found[(20, 10)], found[(10, 10)]], [0.0; 3]);
        assert_eq!(found[(49, 10)], BEYOND);
        // 10 km away the earth has sunk by 7.8 m.
        assert!((sinking(0.0) * 1e8 - 7.848).abs() < 1e-2);
    }
}
