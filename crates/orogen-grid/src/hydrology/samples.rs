//! Grids for the tests of this module: rough, smooth, with steps, with holes.

use super::direction::hashed;
use crate::grid::{Grid, Window};

/// Independent random heights, 0 to 1000.
#[must_use]
pub fn rough(width: usize, height: usize, seed: i64) -> Grid {
    made(width, height, |x, y| (hashed(x, y + 1000 * seed) >> 8) as f32 * (1000.0 / (1 << 24) as f32))
}

/// Hills several cells wide: bilinear value noise of three octaves.
#[must_use]
pub fn hills(width: usize, height: usize, seed: i64) -> Grid {
    made(width, height, |x, y| {
        let octave = |size: i64, weight: f32| {
            let (i, j) = (x.div_euclid(size), y.div_euclid(size));
            let (u, v) = (x.rem_euclid(size) as f32 / size as f32, y.rem_euclid(size) as f32 / size as f32);
            let at = |i: i64, j: i64| (hashed(i + size * 77, j + 1000 * seed) >> 8) as f32 / (1 << 24) as f32;
            let north = at(i, j) * (1.0 - u) + at(i + 1, j) * u;
            let south = at(i, j + 1) * (1.0 - u) + at(i + 1, j + 1) * u;
            (north * (1.0 - v) + south * v) * weight
        };
        octave(16, 800.0) + octave(7, 200.0) + octave(3, 50.0)
    })
}

/// Hills rounded to whole numbers, with many flats.
#[must_use]
pub fn steps(width: usize, height: usize, seed: i64) -> Grid {
    let mut grid = hills(width, height, seed);
    grid.data_mut().iter_mut().for_each(|h| *h = (*h / 60.0).floor());
    grid
}

/// Hills with missing samples.
#[must_use]
pub fn holed(width: usize, height: usize, seed: i64) -> Grid {
    let mut grid = hills(width, height, seed);
    for (k, h) in grid.data_mut().iter_mut().enumerate() {
        if hashed(k as i64, 5).is_multiple_of(97) {
            *h = f32::NAN;
        }
    }
    grid
}

/// One grid of each kind, and degenerate ones.
#[must_use]
pub fn grids() -> Vec<Grid> {
    let mut grids = Vec::new();
    for seed in 0..4 {
        grids.extend([rough(33, 21, seed), hills(48, 40, seed), steps(40, 31, seed), holed(37, 45, seed)]);
    }
    for (width, height) in [(1, 1), (2, 7), (7, 2), (3, 3), (0, 4)] {
        grids.push(rough(width, height, 9));
    }
    grids.push(Grid::filled(Window::new(12, 9, 1.0), 7.0));
    grids
}

fn made(width: usize, height: usize, f: impl Fn(i64, i64) -> f32) -> Grid {
    let window = Window::new(width, height, 1.0).at(-11, 1_000_003);
    let mut grid = Grid::filled(window, 0.0);
    for j in 0..height {
        for i in 0..width {
            grid.row_mut(j)[i] = f(window.x + i as i64, window.y + j as i64);
        }
    }
    grid
}
