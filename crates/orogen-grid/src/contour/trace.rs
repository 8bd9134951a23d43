//! Contours of a grid.

use std::ops::Range;

use crate::parallel;

use super::band::{Band, Levels, NONE};
use super::levels::given;
use super::line::{Line, twice_area};
use crate::error::{Error, ErrorKind, Result};
use crate::grid::Grid;

/// Number of rows of a band: enough to make the overhead of a band small, and few enough to share the work between
/// cores.
const ROWS: usize = 128;

/// The contours of a grid at these levels (in any order), with marching squares on its samples.
///
/// Samples are lattice points, so lines reach the border of the window: an open line ends there, or at a hole. All
/// other lines are rings. Higher ground is to the left ([`Line`]). A point is where the linear interpolation between
/// two neighboring samples reaches the level.
///
/// *Ties.* A sample exactly at a level counts as higher ground. A line passes it once; a flat at the level is outlined.
/// Rings that then enclose nothing (a single summit that just reaches the level) are dropped.
///
/// *Holes.* A cell with a corner that is not finite has no lines.
///
/// Lines are ordered by level, then open lines before rings, then by their starting points in rows from the north.
/// Rings start at their northernmost row. The order does not depend on the number of threads. The time is O(samples +
/// crossings), the memory about 24 bytes per crossing.
///
/// ```
/// use orogen_grid::contour::trace::contours;
/// use orogen_grid::{Grid, Window};
///
/// let slope = Grid::from_data(Window::new(3, 2, 10.0), vec![0.0, 50.0, 100.0, 0.0, 50.0, 100.0]).unwrap();
/// let lines = contours(&slope, &[75.0])?;
/// // Higher ground is in the east, so the line runs south.
/// assert_eq!(lines[0].points, [[15.0, 0.0], [15.0, 10.0]]);
/// # Ok::<(), orogen_grid::Error>(())
/// ```
///
/// # Errors
/// If a level is not finite, or there are more than 2^32 crossings.
pub fn contours(grid: &Grid, levels: &[f64]) -> Result<Vec<Line>> {
    let levels = given(levels)?;
    if grid.width() < 2 || grid.height() < 2 || levels.is_empty() {
        return Ok(Vec::new());
    }
    let ready = Levels::new(&levels);
    let bands = parallel::map(pieces(grid.height(), ROWS), |rows| Band::of(grid, rows, &ready));
    let crossings = joined(bands)?;
    Ok(follow(crossings, grid, &levels))
}

/// The rows 0 .. `height` split into bands.
fn pieces(height: usize, rows: usize) -> Vec<Range<usize>> {
    (0..height).step_by(rows).map(|start| start..(start + rows).min(height)).collect()
}

/// Joins all bands into one.
fn joined(bands: Vec<Band>) -> Result<Band> {
    let total: usize = bands.iter().map(|band| band.own).sum();
    if total >= NONE as usize {
        let message = format!(
            "the contours would have {total} points, and at most 4 294 967 294 are supported; use fewer contours or a larger cell"
        );
        return Err(Error::new(ErrorKind::Request, message));
    }
    let mut whole = Band { own: total, ..Band::default() };
    whole.points.reserve_exact(total);
    whole.next.reserve_exact(total);
    whole.entered.reserve_exact(total);
    whole.level.reserve_exact(total);
    // The links of the previous band for the first crossings of this one.
    let mut said: Vec<(u32, bool)> = Vec::new();
    for band in bands {
        let base = whole.points.len();
        let shifted = |next: u32| if next == NONE { NONE } else { next + base as u32 };
        whole.points.extend_from_slice(&band.points[..band.own]);
        whole.level.extend_from_slice(&band.level[..band.own]);
        whole.next.extend(band.next[..band.own].iter().map(|next| shifted(*next)));
        whole.entered.extend_from_slice(&band.entered[..band.own]);
        for (k, (next, entered)) in said.drain(..).enumerate() {
            if next != NONE {
                whole.next[base + k] = next;
            }
            whole.entered[base + k] |= entered;
        }
        said.extend(
            band.next[band.own..].iter().map(|next| shifted(*next)).zip(band.entered[band.own..].iter().copied()),
        );
    }
    Ok(whole)
}

/// Follows every line from crossing to crossing.
fn follow(mut crossings: Band, grid: &Grid, levels: &[f64]) -> Vec<Line> {
    let mut found: Vec<Vec<Line>> = levels.iter().map(|_| Vec::new()).collect();
    let mut walked: Vec<[f64; 2]> = Vec::new();
    for closed in [false, true] {
        for start in 0..crossings.own {
            if crossings.next[start] == NONE || !closed && crossings.entered[start] {
                continue;
            }
            walked.clear();
            let mut at = start;
            loop {
                push(&mut walked, crossings.points[at]);
                // The link is removed, so that no line is followed twice.
                let next = std::mem::replace(&mut crossings.next[at], NONE);
                if next == NONE || next as usize == start {
                    break;
                }
                at = next as usize;
            }
            let points = if closed { ring(&walked) } else { &walked[..] };
            if points.len() < 2 {
                continue;
            }
            let level = usize::from(crossings.level[start]);
            found[level].push(Line { elevation: levels[level], level, closed, points: placed(points, grid) });
        }
    }
    found.into_iter().flatten().collect()
}

/// Adds a point unless it equals the last one. If the line turns back on itself, the dead end is removed. Both occur
/// only between samples at the level.
fn push(walked: &mut Vec<[f64; 2]>, point: [f64; 2]) {
    match walked.as_slice() {
        [.., last] if *last == point => {}
        [.., before, _] if *before == point => {
            walked.pop();
        }
        _ => walked.push(point),
    }
}

/// A ring without a dead end at its start; empty if it encloses nothing.
fn ring(walked: &[[f64; 2]]) -> &[[f64; 2]] {
    let mut points = walked;
    loop {
        points = match points {
            [first, middle @ .., last] if first == last => &points[..=middle.len()],
            [_, second, .., last] if second == last => &points[1..points.len() - 1],
            [first, .., before, _] if before == first => &points[..points.len() - 2],
            _ => break,
        };
    }
    if points.len() < 3 || twice_area(points) == 0.0 { &[] } else { points }
}

/// Converts columns and rows to metres.
fn placed(points: &[[f64; 2]], grid: &Grid) -> Vec<[f64; 2]> {
    let window = grid.window();
    let (x, y) = (window.x as f64, window.y as f64);
    points.iter().map(|[i, j]| [(x + i) * window.cell, (y + j) * window.cell]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Window;

    fn grid(width: usize, height: usize, of: impl Fn(usize, usize) -> f32) -> Grid {
        let mut grid = Grid::filled(Window::new(width, height, 1.0), 0.0);
        for j in 0..height {
            for i in 0..width {
                grid.row_mut(j)[i] = of(i, j);
            }
        }
        grid
    }

    /// Random numbers, 0 to 1.
    fn noise(seed: u32, i: usize, j: usize) -> f32 {
        let mut x = (i as u32).wrapping_mul(0x9e37_79b1) ^ (j as u32).wrapping_mul(0x85eb_ca6b) ^ seed;
        x = (x ^ x >> 15).wrapping_mul(0x2c1b_3c6d);
        x = (x ^ x >> 12).wrapping_mul(0x297a_2d39);
        ((x ^ x >> 15) >> 8) as f32 / (1 << 24) as f32
    }

    /// Noise with ties: heights in eighths.
    fn rough(seed: u32, width: usize, height: usize) -> Grid {
        grid(width, height, |i, j| (noise(seed, i, j) * 8.0).round() / 8.0)
    }

    #[test]
    fn a_slope_ends_on_the_border() {
        let slope = grid(5, 4, |i, _| i as f32 * 10.0);
        let lines = contours(&slope, &[15.0, 40.0, 0.0, -5.0]).unwrap();
        // Level 0 is the lowest height, so all samples count as above it. Level 40 follows the border.
        assert_eq!(lines.iter().map(|line| line.elevation).collect::<Vec<_>>(), [15.0, 40.0]);
        assert_eq!(lines[0].points, (0..4).map(|j| [1.5, f64::from(j)]).collect::<Vec<_>>());
        assert_eq!(lines[1].points, (0..4).map(|j| [4.0, f64::from(j)]).collect::<Vec<_>>());
    }

    #[test]
    fn a_summit_has_a_ring_and_a_hollow_one_the_other_way_around() {
        for (sign, way) in [(1.0, 1.0), (-1.0, -1.0)] {
            let cone = grid(41, 31, |i, j| {
                let (x, y) = (i as f32 - 20.0, j as f32 - 15.0);
                sign * (10.0 - (x * x + y * y).sqrt())
            });
            let lines = contours(&cone, &[0.0]).unwrap();
            assert_eq!((lines.len(), lines[0].closed), (1, true));
            let circle = std::f64::consts::PI * 100.0;
            assert!((lines[0].area() * way / circle - 1.0).abs() < 0.01, "{}", lines[0].area());
        }
    }

    #[test]
    fn where_a_window_lies_moves_its_lines() {
        let mut there = Grid::filled(Window::new(2, 3, 30.0).at(-7, 1000), 0.0);
        (0..3).for_each(|j| there.row_mut(j)[1] = 1.0);
        let lines = contours(&there, &[0.5]).unwrap();
        assert_eq!(lines[0].points, [[-195.0, 30_000.0], [-195.0, 30_030.0], [-195.0, 30_060.0]]);
    }

    #[test]
    fn a_saddle_is_cut_as_the_surface_through_its_corners_is() {
        let saddle = grid(2, 2, |i, j| if i == j { 1.0 } else { 0.0 });
        // The value in the middle is 0.5. Below it, the high corners are connected.
        for (level, south) in [(0.4, 0.4), (0.6, 0.6)] {
            let lines = contours(&saddle, &[level]).unwrap();
            assert_eq!(lines.len(), 2);
            let joined = level < 0.5;
            let north = &lines.iter().find(|line| line.points.iter().any(|p| p[1] == 0.0)).unwrap().points;
            // A line from the northern edge leads east around the low north-east corner, or west around the high
            // north-west corner.
            assert_eq!(north.iter().any(|p| p[0] == 1.0), joined, "{north:?}");
            assert!(lines.iter().flat_map(|l| &l.points).any(|p| p[1] == south || 1.0 - p[1] == south), "{lines:?}");
        }
    }

    #[test]
    fn ties_leave_no_duplicates() {
        // A plateau at the level is outlined once; a single summit, a ridge one sample wide and a flat world have no
        // line.
        let plateau = grid(6, 6, |i, j| f32::from(u8::from((2..4).contains(&i) && (2..4).contains(&j))));
        let lines = contours(&plateau, &[1.0]).unwrap();
        assert_eq!((lines.len(), lines[0].closed, lines[0].area(), lines[0].points.len()), (1, true, 1.0, 4));
        assert!(contours(&grid(5, 5, |i, j| f32::from(u8::from((i, j) == (2, 2)))), &[1.0]).unwrap().is_empty());
        assert!(
            contours(&grid(9, 5, |i, j| f32::from(u8::from((2..7).contains(&i) && j == 2))), &[1.0])
                .unwrap()
                .is_empty()
        );
        assert!(contours(&grid(5, 5, |_, _| 1.0), &[1.0]).unwrap().is_empty());
        for seed in 0..20 {
            let levels: Vec<f64> = (0..=8).map(|k| f64::from(k) / 8.0).collect();
            for line in contours(&rough(seed, 23, 17), &levels).unwrap() {
                assert!(line.points.windows(2).all(|pair| pair[0] != pair[1]), "{line:?}");
                assert!(line.points.windows(3).all(|three| three[0] != three[2]), "{line:?}");
                assert!(!line.closed || line.points.len() > 2 && line.points[0] != line.points[line.points.len() - 1]);
            }
        }
    }

    /// Invariants of any field: every crossing of an edge is on exactly one line, with higher ground to the left of it.
    #[test]
    fn every_crossing_is_on_a_line_and_higher_ground_to_its_left() {
        for seed in 0..12 {
            let (width, height) = (31, 300);
            let field = grid(width, height, |i, j| noise(seed, i, j));
            let levels = [0.2, 0.5, 0.7];
            let lines = contours(&field, &levels).unwrap();
            let mut crossings = 0;
            for j in 0..height {
                for i in 0..width {
                    for (x, y) in [(i + 1, j), (i, j + 1)].into_iter().filter(|&(x, y)| x < width && y < height) {
                        let (a, b) = (f64::from(field[(i, j)]), f64::from(field[(x, y)]));
                        crossings += levels.iter().filter(|level| (a >= **level) != (b >= **level)).count();
                    }
                }
            }
            assert_eq!(lines.iter().map(|line| line.points.len()).sum::<usize>(), crossings);
            for line in &lines {
                let on_border = |p: &[f64; 2]| {
                    p[0] == 0.0 || p[1] == 0.0 || p[0] == (width - 1) as f64 || p[1] == (height - 1) as f64
                };
                if !line.closed {
                    assert!(on_border(&line.points[0]) && on_border(line.points.last().unwrap()));
                }
                for (a, b) in line.path().zip(line.path().skip(1)) {
                    assert_eq!([a, b].map(|p| p[0].fract() != 0.0 && p[1].fract() != 0.0), [false; 2]);
                    // At a crossing, the high corner of the edge is to the left of the line.
                    let [low, high] = [[a[0].floor(), a[1].floor()], [a[0].ceil(), a[1].ceil()]];
                    for corner in [low, high] {
                        let side = (a[1] - b[1]) * (corner[0] - a[0]) - (b[0] - a[0]) * (a[1] - corner[1]);
                        let at = f64::from(field[(corner[0] as usize, corner[1] as usize)]);
                        // Twice the area, counter-clockwise on a map.
                        let left = -side > 0.0;
                        assert_eq!(at >= line.elevation, left, "{a:?} {b:?} {corner:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn lines_never_cross() {
        for seed in 0..6 {
            let field = grid(14, 12, |i, j| noise(seed, i, j));
            let levels: Vec<f64> = (1..20).map(|k| f64::from(k) / 20.0).collect();
            let lines = contours(&field, &levels).unwrap();
            let pieces: Vec<([f64; 2], [f64; 2])> =
                lines.iter().flat_map(|line| line.path().zip(line.path().skip(1)).collect::<Vec<_>>()).collect();
            let side =
                |a: [f64; 2], b: [f64; 2], p: [f64; 2]| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
            for (k, (a, b)) in pieces.iter().enumerate() {
                for (c, d) in &pieces[k + 1..] {
                    let apart =
                        side(*a, *b, *c) * side(*a, *b, *d) < -1e-12 && side(*c, *d, *a) * side(*c, *d, *b) < -1e-12;
                    assert!(!apart, "{a:?} {b:?} crosses {c:?} {d:?}");
                }
            }
        }
    }

    #[test]
    fn bands_make_no_difference() {
        let field = grid(40, 301, |i, j| (noise(7, i / 3, j / 3) + noise(8, i, j) * 0.2) * 0.8);
        let levels = [0.25, 0.5, 0.75];
        let ready = Levels::new(&levels);
        let cut = |rows| {
            let bands = pieces(301, rows).into_iter().map(|rows| Band::of(&field, rows, &ready)).collect();
            follow(joined(bands).unwrap(), &field, &levels)
        };
        let whole = cut(301);
        assert!(whole.len() > 50);
        for rows in [1, 2, 7, 128, 300] {
            assert!(cut(rows) == whole, "{rows}");
        }
        assert!(contours(&field, &levels).unwrap() == whole);
    }

    #[test]
    fn holes_cut_lines() {
        let mut slope = grid(9, 9, |i, _| i as f32);
        slope.row_mut(4)[4] = f32::NAN;
        slope.row_mut(7)[0] = f32::INFINITY;
        let lines = contours(&slope, &[3.5, 6.5]).unwrap();
        let ends: Vec<(f64, f64, f64)> = lines
            .iter()
            .map(|line| (line.elevation, line.points[0][1], line.points[line.points.len() - 1][1]))
            .collect();
        assert_eq!(ends, [(3.5, 0.0, 3.0), (3.5, 5.0, 8.0), (6.5, 0.0, 8.0)]);
        assert!(contours(&grid(4, 4, |_, _| f32::NAN), &[1.0]).unwrap().is_empty());
        assert!(contours(&grid(1, 4, |_, j| j as f32), &[1.0]).unwrap().is_empty());
    }
}
