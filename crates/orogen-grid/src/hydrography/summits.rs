//! Summits with their prominence.

use super::water::Frame;
use crate::grid::Grid;
use crate::parallel;

/// A summit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summit {
    /// Column and row.
    pub place: [usize; 2],
    /// Height of the summit, in metres.
    pub height: f32,
    /// Metres down to the key col; for the highest summit, to the lowest ground or to the sea.
    pub prominence: f32,
    /// Column and row of the key col, the highest pass to higher ground; `None` for the highest summit.
    pub col: Option<[usize; 2]>,
}

/// Memory per sample of the search, in bytes.
pub const MEMORY: u64 = 16;

const NOT_YET: u32 = u32::MAX;

/// The summits within a frame with a prominence of at least `least` metres, the most prominent first. Samples in the
/// sea are excluded, and so are samples at the border of the frame, where the ground may continue to rise.
///
/// Samples are processed from the highest down and joined to their processed neighbors. Where two hills meet, the
/// sample is the key col of the lower summit (union-find, O(n log n)). Of equal heights the first in row order counts
/// as higher.
#[must_use]
pub fn summits(heights: &Grid, frame: &Frame, sea_level: Option<f32>, least: f32) -> Vec<Summit> {
    let (columns, rows) = (&frame.columns, &frame.rows);
    let (width, height) = (columns.len(), rows.len());
    let at = |cell: usize| heights[(columns.start + cell % width, rows.start + cell / width)];
    let sea = sea_level.unwrap_or(f32::NEG_INFINITY);
    let mut order: Vec<u32> = (0..width * height).filter(|cell| at(*cell) > sea).map(|cell| cell as u32).collect();
    order.retain(|cell| at(*cell as usize).is_finite());
    parallel::sort_by(&mut order, |a, b| at(*b as usize).total_cmp(&at(*a as usize)).then(a.cmp(b)));
    let Some(lowest) = order.last().map(|cell| at(*cell as usize)) else { return Vec::new() };
    // The hill of each sample, as a union-find forest: a summit is its own parent.
    let mut parents = vec![NOT_YET; width * height];
    let higher = |a: u32, b: u32| (at(a as usize), b) > (at(b as usize), a);
    let mut found: Vec<(u32, f32, Option<u32>)> = Vec::new();
    for cell in &order {
        parents[*cell as usize] = *cell;
        let (i, j) = (*cell as usize % width, *cell as usize / width);
        for y in j.saturating_sub(1)..(j + 2).min(height) {
            for x in i.saturating_sub(1)..(i + 2).min(width) {
                let other = y * width + x;
                if parents[other] == NOT_YET || other == *cell as usize {
                    continue;
                }
                let (a, b) = (root(&mut parents, *cell), root(&mut parents, other as u32));
                if a == b {
                    continue;
                }
                let (upper, lower) = if higher(a, b) { (a, b) } else { (b, a) };
                parents[lower as usize] = upper;
                // A sample that only joins an existing hill is not a summit.
                if lower != *cell {
                    found.push((lower, at(lower as usize) - at(*cell as usize), Some(*cell)));
                }
            }
        }
    }
    let sea_there = sea_level.filter(|_| order.len() < width * height);
    let base = sea_there.unwrap_or(lowest);
    found.extend((0..parents.len()).filter(|k| parents[*k] == *k as u32).map(|k| (k as u32, at(k) - base, None)));
    let place = |cell: u32| [columns.start + cell as usize % width, rows.start + cell as usize / width];
    let inner = |cell: u32| {
        let (i, j) = (cell as usize % width, cell as usize / width);
        i > 0 && j > 0 && i + 1 < width && j + 1 < height
    };
    let mut summits: Vec<Summit> = (found.into_iter())
        .filter(|(cell, prominence, _)| *prominence >= least && *prominence > 0.0 && inner(*cell))
        .map(|(cell, prominence, col)| Summit {
            place: place(cell),
            height: at(cell as usize),
            prominence,
            col: col.map(place),
        })
        .collect();
    summits.sort_by(|a, b| {
        b.prominence.total_cmp(&a.prominence).then([a.place[1], a.place[0]].cmp(&[b.place[1], b.place[0]]))
    });
    summits
}

/// The summit of the hill of a sample, with path compression.
fn root(parents: &mut [u32], from: u32) -> u32 {
    let mut at = from;
    while parents[at as usize] != at {
        let over = parents[parents[at as usize] as usize];
        parents[at as usize] = over;
        at = over;
    }
    at
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Window;

    #[test]
    fn prominence_is_the_way_down_to_the_key_col() {
        let picture = [
            "0000000000", //
            "0520070000",
            "0320130090",
            "0000010000",
            "0000000000",
        ];
        let data: Vec<f32> = picture.iter().flat_map(|row| row.bytes().map(|byte| f32::from(byte - b'0'))).collect();
        let grid = Grid::from_data(Window::new(10, 5, 1.0), data).unwrap();
        let frame = Frame { columns: 0..10, rows: 0..5 };
        let found = summits(&grid, &frame, None, 1.0);
        let got: Vec<([usize; 2], f32, f32)> = found.iter().map(|s| (s.place, s.height, s.prominence)).collect();
        assert_eq!(got, [([8, 2], 9.0, 9.0), ([5, 1], 7.0, 7.0), ([1, 1], 5.0, 5.0)]);
        assert_eq!((found[0].col, found[1].col.is_some()), (None, true));
        // With the sea at 0, each hill is an island.
        let islands = summits(&grid, &frame, Some(0.0), 1.0);
        assert!(islands.iter().all(|summit| summit.col.is_none() && summit.prominence == summit.height));
        // A sample at the border of the frame is not a summit.
        assert_eq!(summits(&grid, &Frame { columns: 5..10, rows: 1..5 }, None, 1.0).len(), 1);
        assert_eq!(summits(&grid, &frame, None, 6.0).len(), 2);
    }
}
