//! Peaks: samples that are the highest within a distance. Unlike summits by their prominence, they depend on a finite
//! halo only.

use crate::grid::{Grid, Window};
use crate::parallel;

/// The columns and rows, within a window of the grid at the same cell, of samples above `least` that are higher than
/// all others within `radius` samples, row by row. Of equal heights, the first in row order counts as higher. A sample
/// whose surroundings extend beyond the grid is compared with those that there are.
#[must_use]
pub fn peaks(heights: &Grid, within: &Window, radius: usize, least: f32) -> Vec<[usize; 2]> {
    let all = heights.window();
    let (columns, rows) = (heights.width() as i64, heights.height() as i64);
    let (left, top) = (within.x - all.x, within.y - all.y);
    let [first, last] = [top.clamp(0, rows), (top + within.height as i64).clamp(0, rows)];
    let [west, east] = [left.clamp(0, columns), (left + within.width as i64).clamp(0, columns)];
    let reach = radius as i64;
    let is_peak = |x: i64, y: i64| {
        let height = heights[(x as usize, y as usize)];
        let is_lower = |u: i64, v: i64| {
            let other = heights[(u as usize, v as usize)];
            other.is_nan() || other < height || other == height && (v, u) >= (y, x)
        };
        let square = |r: i64| {
            let [top, bottom] = [(y - r).max(0), (y + r).min(rows - 1)];
            let [start, end] = [(x - r).max(0), (x + r).min(columns - 1)];
            (top..=bottom).flat_map(move |v| (start..=end).map(move |u| (u, v)))
        };
        let is_near = |(u, v): &(i64, i64)| (u - x) * (u - x) + (v - y) * (v - y) <= reach * reach;
        // The neighbors first, because most samples are no local maximum.
        height > least
            && square(1).all(|(u, v)| is_lower(u, v))
            && square(reach).filter(is_near).all(|(u, v)| is_lower(u, v))
    };
    let of_row = |y: usize| -> Vec<[usize; 2]> {
        (west..east).filter(|x| is_peak(*x, y as i64)).map(|x| [x as usize, y]).collect()
    };
    parallel::map(first as usize..last as usize, of_row).into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn peaks_of_windows_are_those_of_the_whole() {
        let height = |i: i64, j: i64| (libm::sin(i as f64 / 5.0) * libm::cos(j as f64 / 7.0) * 40.0).round() as f32;
        let grid = |x: i64, width: usize| {
            let window = Window::new(width, 60, 1.0).at(x, 0);
            let data = (0..width * 60).map(|k| height(x + (k % width) as i64, (k / width) as i64)).collect();
            Grid::from_data(window, data).unwrap()
        };
        let whole = grid(0, 120);
        let all = peaks(&whole, whole.window(), 10, 5.0);
        assert!(all.len() > 5);
        for [i, j] in &all {
            let top = whole[(*i, *j)];
            assert!(top > 5.0 && whole.data().iter().all(|height| *height <= 40.0));
        }
        let mut parts = Vec::new();
        for x in [0, 60] {
            let part = grid(x - 10, 80);
            let found = peaks(&part, &Window::new(60, 60, 1.0).at(x, 0), 10, 5.0);
            parts.extend(found.into_iter().map(|[i, j]| [i + x as usize - 10, j]));
        }
        parts.sort_by_key(|[i, j]| (*j, *i));
        // West of the whole there is more ground, which only the part sees.
        let inner = |all: &[[usize; 2]]| all.iter().copied().filter(|[i, _]| (10..110).contains(i)).collect::<Vec<_>>();
        assert_eq!(inner(&parts), inner(&all));
    }
}
