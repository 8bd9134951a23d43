//! Sky-view factor: the ambient occlusion of terrain.
//!
//! The sky-view factor (Zakšek, Oštir and Kokalj, "Sky-view factor as a relief visualization technique", Remote Sensing
//! 3, 2011) is the visible share of the hemisphere above a sample: 1 - mean(sin g) over all directions, where g is the
//! elevation angle of the horizon, at least 0. It is 1 on level ground.
//!
//! Horizons are searched in 16 directions along the lattice: the axes, the diagonals, and the knight's moves between
//! them. Each is weighted by its share of the circle. The steps are at 1, 2, 3, 4, 6, 8, 12, 16, 24 ... samples. A
//! distant ridge that is narrower than the gap between two steps may be missed.

use crate::checks::{never, steps as steps_of};
use crate::grid::{Grid, Window};
use crate::progress::Progress;
use crate::{error, parallel};

/// The directions of one quadrant and the degrees that each represents. The others follow by rotation.
const QUARTER: [([i64; 2], f64); 4] =
    [([1, 0], 26.565_051_177_077_99), ([2, 1], 22.5), ([1, 1], 18.434_948_822_922_01), ([1, 2], 22.5)];

/// A step of a direction: its offset on the lattice, its distance in metres, and the direction.
struct Look {
    offset: [i64; 2],
    per_metre: f32,
    direction: usize,
}

/// The steps of all directions up to `reach` samples.
fn looks(reach: usize, cell: f64) -> (Vec<Look>, Vec<f64>) {
    let (mut looks, mut shares) = (Vec::new(), Vec::new());
    for (forward, degrees) in QUARTER {
        for turn in 0..4 {
            let [x, y] = (0..turn).fold(forward, |[x, y], _| [-y, x]);
            let direction = shares.len();
            shares.push(degrees);
            let length = libm::sqrt((x * x + y * y) as f64);
            for steps in steps().take_while(|steps| *steps as f64 * length <= reach as f64) {
                let per_metre = (1.0 / (steps as f64 * length * cell)) as f32;
                looks.push(Look { offset: [x * steps, y * steps], per_metre, direction });
            }
        }
    }
    let total: f64 = shares.iter().sum();
    shares.iter_mut().for_each(|share| *share /= total);
    (looks, shares)
}

/// A step of [`sky_view`], for computations on a GPU.
#[doc(hidden)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ViewStep {
    /// Columns and rows.
    pub offset: [i64; 2],
    /// The inverse of the distance in metres.
    pub per_metre: f32,
    /// The direction's share of the circle at the last step of a direction, otherwise 0.
    pub share: f32,
}

/// The steps of [`sky_view`], direction by direction.
#[doc(hidden)]
#[must_use]
pub fn steps_of_view(reach: usize, cell: f64) -> Vec<ViewStep> {
    let (looks, shares) = looks(reach, cell);
    let next = looks.iter().skip(1).map(|look| Some(look.direction)).chain([None]);
    let step = |(look, next): (&Look, Option<usize>)| {
        let share = if next == Some(look.direction) { 0.0 } else { shares[look.direction] as f32 };
        ViewStep { offset: look.offset, per_metre: look.per_metre, share }
    };
    looks.iter().zip(next).map(step).collect()
}

/// 1, 2, 3, 4, 6, 8, 12, 16, ...
fn steps() -> impl Iterator<Item = i64> {
    [1, 2, 3].into_iter().chain((1..40).flat_map(|power| [4 << (power - 1), 6 << (power - 1)]))
}

/// The sky-view factor, 0 to 1, at the samples of `window`, with horizons up to `reach` samples away. `heights` covers
/// the window and its surroundings; outside it nothing hides the sky. The result is NaN at samples that are not finite;
/// these hide nothing.
#[must_use]
pub fn sky_view(heights: &Grid, window: &Window, reach: usize) -> Grid {
    let Ok(out) = by_rows(heights, window, reach, &never);
    out
}

/// [`sky_view`] with progress and cancellation.
///
/// # Errors
/// If the work is cancelled.
pub fn sky_view_with(heights: &Grid, window: &Window, reach: usize, progress: &Progress) -> error::Result<Grid> {
    by_rows(heights, window, reach, &steps_of(progress, window.height))
}

fn by_rows<E: Send>(
    heights: &Grid,
    window: &Window,
    reach: usize,
    step: &(impl Fn() -> Result<(), E> + Sync),
) -> Result<Grid, E> {
    let (looks, shares) = looks(reach, window.cell);
    let all = heights.window();
    let mut out = Grid::filled(*window, f32::NAN);
    parallel::try_for_each_init(
        out.data_mut().chunks_mut(window.width.max(1)).enumerate(),
        || vec![0.0f32; shares.len()],
        |steepest, (j, row)| {
            step()?;
            for (i, out) in row.iter_mut().enumerate() {
                let (x, y) = (window.x + i as i64 - all.x, window.y + j as i64 - all.y);
                let here = heights[(x as usize, y as usize)];
                if !here.is_finite() {
                    continue;
                }
                steepest.fill(0.0);
                for look in &looks {
                    let (x, y) = (x + look.offset[0], y + look.offset[1]);
                    if (0..all.width as i64).contains(&x) && (0..all.height as i64).contains(&y) {
                        let rise = (heights[(x as usize, y as usize)] - here) * look.per_metre;
                        // False for NaN as well.
                        if rise > steepest[look.direction] {
                            steepest[look.direction] = rise;
                        }
                    }
                }
                let hidden: f64 = (steepest.iter().zip(&shares))
                    .map(|(rise, share)| {
                        let rise = f64::from(*rise);
                        share * (if rise.is_finite() { rise / (1.0 + rise * rise).sqrt() } else { 1.0 })
                    })
                    .sum();
                *out = (1.0 - hidden) as f32;
            }
            Ok(())
        },
    )?;
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn made(side: usize, f: impl Fn(f64, f64) -> f64) -> Grid {
        let window = Window::new(side, side, 2.0).at(-(side as i64) / 2, -(side as i64) / 2);
        let mut grid = Grid::filled(window, 0.0);
        for j in 0..side {
            for i in 0..side {
                grid.row_mut(j)[i] = f(window.east(i), window.south(j)) as f32;
            }
        }
        grid
    }

    fn middle(grid: &Grid, reach: usize) -> f32 {
        sky_view(grid, &Window::new(1, 1, 2.0), reach)[(0, 0)]
    }

    #[test]
    fn open_ground_sees_all_and_a_cone_what_is_left() {
        assert_eq!(middle(&made(65, |_, _| 7.0), 32), 1.0);
        assert_eq!(middle(&made(65, |x, y| -x.abs() - y.abs()), 32), 1.0, "a top");
        // A pit whose sides have a slope of 1 hides sin 45 degrees in all directions.
        let pit = middle(&made(65, libm::hypot), 32);
        assert!((f64::from(pit) - (1.0 - libm::sqrt(0.5))).abs() < 1e-6, "{pit}");
        // An infinitely long and high wall to the east hides half of the sky.
        let wall = middle(&made(65, |x, _| if x > 0.0 { 1e9 } else { 0.0 }), 32);
        assert!((wall - 0.5).abs() < 0.08, "{wall}");
    }

    #[test]
    fn shares_are_the_angles_halfway_to_the_neighbors() {
        let (looks, shares) = looks(32, 2.0);
        assert_eq!(shares.len(), 16);
        assert!((shares.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        assert!((shares[0] * 360.0 - 26.565_051_177).abs() < 1e-6 && (shares[4] * 360.0 - 22.5).abs() < 1e-6);
        assert!(looks.iter().all(|look| look.offset.iter().all(|side| side.abs() <= 32)));
        assert_eq!(steps().take(9).collect::<Vec<_>>(), [1, 2, 3, 4, 6, 8, 12, 16, 24]);
    }

    #[test]
    fn a_window_is_the_crop_of_the_whole() {
        let ground = made(81, |x, y| libm::sin(x * 0.3) * 8.0 + libm::cos(y * 0.2 + x * 0.05) * 6.0);
        let inner = ground.window().shrunk(12);
        let whole = sky_view(&ground, &inner, 12);
        let part = Window { x: 3, y: -7, width: 9, height: 14, ..inner };
        let cut = ground.crop(&part.grown(12)).unwrap();
        assert_eq!(Some(sky_view(&cut, &part, 12)), whole.crop(&part));
    }

    #[test]
    fn what_is_missing_hides_nothing() {
        let mut ground = made(33, libm::hypot);
        ground.row_mut(16)[20] = f32::NAN;
        assert!(middle(&ground, 16) > 0.28);
        assert!(sky_view(&ground, &Window::new(1, 1, 2.0).at(4, 0), 16)[(0, 0)].is_nan());
    }
}
