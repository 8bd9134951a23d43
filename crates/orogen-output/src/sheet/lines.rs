//! Contours of a sheet: choice of the interval, and removal of lines that are too short.

use orogen_grid::contour::chaikin::chaikin;
use orogen_grid::contour::levels::{is_index, levels_every};
use orogen_grid::contour::line::Line;
use orogen_grid::contour::trace::contours;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};

/// Minimum distance between contours on steep ground, in millimetres; a tenth of the ground is steeper.
const CLOSEST: f64 = 0.5;

/// Minimum and maximum number of contours over the whole relief.
const FEWEST: f64 = 8.0;
const MOST: f64 = 60.0;

/// Minimum length of rings, in millimetres.
const SHORTEST: f64 = 3.0;

/// Round intervals of published maps.
const ROUND: [f64; 5] = [1.0, 2.0, 2.5, 5.0, 10.0];

/// A contour interval for a map on which a sample is `sample` millimetres wide, in metres.
pub fn interval(heights: &Grid, sea_level: Option<f64>, sample: f64) -> f64 {
    let sea = sea_level.unwrap_or(f64::NEG_INFINITY) as f32;
    let (mut low, mut high) = (f32::MAX, f32::MIN);
    let mut rises: Vec<f32> = Vec::new();
    for j in 0..heights.height() {
        for pair in heights.row(j).windows(2) {
            if pair.iter().all(|height| height.is_finite() && *height > sea) {
                (low, high) = (low.min(pair[0]).min(pair[1]), high.max(pair[0]).max(pair[1]));
                rises.push((pair[1] - pair[0]).abs());
            }
        }
    }
    if rises.is_empty() {
        // Without land, the interval of the sea floor.
        return if sea_level.is_some() { interval(heights, None, sample) } else { 1.0 };
    }
    let at = rises.len() * 9 / 10;
    let steep = f64::from(*rises.select_nth_unstable_by(at, f32::total_cmp).1) / sample;
    let relief = f64::from(high - low);
    let wanted = (steep * CLOSEST).clamp(relief / MOST, (relief / FEWEST).max(relief / MOST));
    if !(wanted > 1e-6 && wanted < 1e9) {
        return 1.0;
    }
    let power = libm::pow(10.0, libm::log10(wanted).floor());
    // 2.5 only for 25 and 250: intervals of 2.5 m are not in use.
    let rounds = ROUND.into_iter().filter(|n| *n != 2.5 || power >= 10.0);
    rounds.map(|n| n * power).find(|step| *step >= wanted * 0.95).unwrap_or(10.0 * power)
}

/// The contours of heights with samples of `sample` millimetres: smoothed, without a contour at sea level and without
/// short rings.
///
/// # Errors
/// If there are too many levels for the relief.
pub fn lines(heights: &Grid, interval: f64, sea_level: Option<f64>, sample: f64) -> Result<Vec<Line>> {
    let ends = heights.data().iter().copied().filter(|height| height.is_finite());
    let (low, high) = ends.fold((f32::MAX, f32::MIN), |(low, high), height| (low.min(height), high.max(height)));
    let mut levels = levels_every(interval, f64::from(low), f64::from(high))?;
    levels.retain(|level| sea_level != Some(*level));
    lines_at(heights, &levels, sample)
}

/// The contours at these levels, in ascending order, smoothed and without short rings.
///
/// # Errors
/// If there are too many lines.
pub fn lines_at(heights: &Grid, levels: &[f64], sample: f64) -> Result<Vec<Line>> {
    let cell = heights.window().cell;
    let mut lines = contours(heights, levels)?;
    lines.retain(|line| !line.closed || line.length() / cell * sample >= SHORTEST);
    Ok(lines.iter().map(|line| chaikin(line, 1)).collect())
}

/// The interval of index contours: every fifth contour, or every fourth for 25 m and similar, which gives round
/// numbers.
pub fn thick_interval(interval: f64) -> f64 {
    let power = libm::pow(10.0, libm::log10(interval).floor());
    let digits = interval / power;
    if (digits - 2.5).abs() < 1e-6 { 4.0 * interval } else { 5.0 * interval }
}

/// Whether a line is an index contour.
pub fn is_thick(line: &Line, interval: f64) -> bool {
    is_index(line.elevation, thick_interval(interval) / 5.0)
}

/// A summit: a sample, and its height.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summit {
    /// Its column.
    pub x: usize,
    /// Its row.
    pub y: usize,
    /// Its height in metres.
    pub height: f32,
}

/// Finds summits: the highest samples within `apart` blocks of `block` x `block` samples, the highest first. Returns at
/// most `most`. Samples at the border and samples that are not above their surroundings are excluded.
///
/// The height of a block is the height of its highest sample, so that each summit is the highest sample nearby.
pub fn summits(heights: &Grid, sea_level: Option<f64>, block: usize, apart: usize, most: usize) -> Vec<Summit> {
    let sea = sea_level.unwrap_or(f64::NEG_INFINITY) as f32;
    let blocks = blocks(heights, block.max(1));
    let (width, height) = (blocks.width(), blocks.height());
    let mut found: Vec<Summit> = Vec::new();
    for j in 2..height.saturating_sub(2) {
        for i in 2..width.saturating_sub(2) {
            let Some(summit) = blocks[(i, j)] else { continue };
            let here = summit.height;
            // The nearest blocks are tested first, which rejects almost all candidates. Missing samples are ignored.
            let top = |reach: usize| {
                let rows = j.saturating_sub(reach)..(j + reach + 1).min(height);
                rows.into_iter().all(|y| {
                    let row = &blocks.row(y)[i.saturating_sub(reach)..(i + reach + 1).min(width)];
                    row.iter().all(|other| other.is_some_and(|other| other.height <= here))
                })
            };
            let lower = |other: Option<Summit>| other.is_some_and(|other| other.height < here);
            let stands_out = || lower(blocks[(i - 2, j)]) || lower(blocks[(i + 2, j)]);
            if here > sea && top(1) && top(apart / 2) && stands_out() {
                found.push(summit);
            }
        }
    }
    found.sort_by(|a, b| b.height.total_cmp(&a.height).then((a.y, a.x).cmp(&(b.y, b.x))));
    let mut kept: Vec<Summit> = Vec::new();
    for summit in found {
        let far = |other: &Summit| other.x.abs_diff(summit.x).max(other.y.abs_diff(summit.y)) >= apart * block.max(1);
        if kept.len() < most && kept.iter().all(far) {
            kept.push(summit);
        }
    }
    kept
}

/// The highest finite sample of each block, the first in row order if there are several.
fn blocks(heights: &Grid, block: usize) -> Grid<Option<Summit>> {
    let window = Window::new(heights.width().div_ceil(block), heights.height().div_ceil(block), 1.0);
    let mut blocks: Grid<Option<Summit>> = Grid::filled(window, None);
    for y in 0..heights.height() {
        let highest = blocks.row_mut(y / block);
        for (x, height) in heights.row(y).iter().copied().enumerate().filter(|(_, height)| height.is_finite()) {
            let highest = &mut highest[x / block];
            if highest.is_none_or(|highest| height > highest.height) {
                *highest = Some(Summit { x, y, height });
            }
        }
    }
    blocks
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hills(height: f32) -> Grid {
        let mut grid = Grid::filled(Window::new(200, 160, 50.0), 0.0);
        for j in 0..160 {
            for i in 0..200 {
                let hill = |x: f64, y: f64, r: f64| {
                    let (dx, dy) = (i as f64 - x, j as f64 - y);
                    libm::exp(-(dx * dx + dy * dy) / (r * r))
                };
                grid.row_mut(j)[i] = height * (hill(60.0, 80.0, 40.0) + 0.6 * hill(150.0, 70.0, 30.0)) as f32;
            }
        }
        grid
    }

    #[test]
    fn the_interval_is_round_and_follows_the_relief() {
        for (height, expect) in [(3000.0, 100.0), (300.0, 10.0), (30.0, 1.0)] {
            let step = interval(&hills(height), None, 0.25);
            let levels = f64::from(height) / step;
            assert!((8.0..=60.0).contains(&levels) && (step / expect - 1.0).abs() < 1.6, "{height}: {step}");
        }
        assert_eq!([20.0, 25.0, 250.0, 1.0].map(thick_interval), [100.0, 100.0, 1000.0, 5.0]);
        assert_eq!(interval(&Grid::filled(Window::new(9, 9, 1.0), 5.0), None, 0.25), 1.0);
        assert!(interval(&hills(300.0), Some(1e4), 0.25) > 0.0, "all sea");
    }

    #[test]
    fn summits_are_the_highest_and_apart() {
        let grid = hills(1000.0);
        let places = |sea: Option<f64>, apart: usize, most: usize| -> Vec<(usize, usize)> {
            summits(&grid, sea, 1, apart, most).iter().map(|summit| (summit.x, summit.y)).collect()
        };
        // The foot of the higher hill moves the apparent summit of the lower one.
        assert_eq!(places(None, 40, 5), [(60, 80), (149, 70)]);
        assert_eq!(places(None, 40, 1), [(60, 80)]);
        assert_eq!(places(None, 150, 5), [(60, 80)]);
        assert!(places(Some(2000.0), 40, 5).is_empty());
        assert!(summits(&Grid::filled(Window::new(50, 50, 1.0), 5.0), None, 1, 10, 5).is_empty());
    }

    #[test]
    fn a_summit_is_the_highest_sample_however_coarse_the_map() {
        let mut grid = hills(1000.0);
        // A spire of one sample, higher than any mean of its surroundings.
        grid.row_mut(83)[63] = 1234.5;
        for block in [1, 2, 3, 7, 10] {
            let found = summits(&grid, None, block, 40 / block, 5);
            assert_eq!(found[0], Summit { x: 63, y: 83, height: 1234.5 }, "{block}");
            assert!(found.len() == 2 && found[1].height == grid[(149, 70)], "{block}: {found:?}");
        }
    }

    #[test]
    fn short_rings_and_the_shore_are_left_out() {
        let grid = hills(1000.0);
        let all = lines(&grid, 100.0, Some(200.0), 0.25).unwrap();
        assert!(all.iter().all(|line| line.elevation != 200.0) && all.iter().any(|line| line.elevation == 300.0));
        // A given level is drawn, also at sea level.
        let given = lines_at(&grid, &[200.0, 450.0], 0.25).unwrap();
        let heights: Vec<f64> = given.iter().map(|line| line.elevation).collect();
        assert_eq!((heights.first(), heights.last()), (Some(&200.0), Some(&450.0)));
        let small = lines(&grid, 100.0, None, 0.005).unwrap();
        assert!(small.iter().all(|line| !line.closed));
    }
}
