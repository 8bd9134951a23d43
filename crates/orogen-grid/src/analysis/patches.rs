//! Samples whose values are within bounds, and the connected parts of them.

use std::ops::Range;

use crate::grid::Grid;

/// Bounds of a value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// The least and the greatest value.
    pub range: [f64; 2],
    /// Whether the value must be within the range, and not outside of it. NaN is neither.
    pub is_within: bool,
}

impl Bounds {
    /// Whether a value satisfies the bounds.
    #[must_use]
    pub fn hold(&self, value: f64) -> bool {
        let [least, greatest] = self.range;
        !value.is_nan() && (least <= value && value <= greatest) == self.is_within
    }
}

/// Which sample of a part is its best.
#[derive(Debug, Clone, Copy)]
pub enum Rank<'a> {
    /// The one that is nearest to a position, in columns and rows.
    Nearest([f64; 2]),
    /// The one with the largest value.
    Largest(&'a Grid),
}

impl Rank<'_> {
    fn of(&self, k: usize, width: usize) -> f64 {
        match self {
            Rank::Nearest([x, y]) => libm::hypot((k % width) as f64 - x, (k / width) as f64 - y),
            Rank::Largest(values) => -f64::from(values.data()[k]),
        }
    }
}

/// The samples at which each grid's value satisfies its bounds. All grids have one size.
#[must_use]
pub fn marked(grids: &[(&Grid, Bounds)]) -> Vec<bool> {
    let samples = grids.first().map_or(0, |(grid, _)| grid.data().len());
    let mut marked = vec![true; samples];
    for (grid, bounds) in grids {
        marked.iter_mut().zip(grid.data()).for_each(|(marked, value)| *marked &= bounds.hold(f64::from(*value)));
    }
    marked
}

/// The connected parts of marked samples of a grid that is `width` samples wide, and the best sample of each part
/// within these columns and rows.
#[must_use]
pub fn parts(mut marked: Vec<bool>, width: usize, [columns, rows]: [Range<usize>; 2], rank: Rank) -> Vec<Patch> {
    patches(&mut marked, width, |k| {
        (columns.contains(&(k % width)) && rows.contains(&(k / width))).then(|| rank.of(k, width))
    })
}

/// The blocks of `side` x `side` samples that have a marked sample, row by row: column and row of the block, and the
/// rank of its best sample.
#[must_use]
pub fn blocks(marked: &[bool], width: usize, side: usize, rank: Rank) -> Vec<([usize; 2], f64)> {
    let across = width.div_ceil(side);
    let mut best = vec![f64::INFINITY; across * (marked.len() / width.max(1)).div_ceil(side)];
    let mut has = vec![false; best.len()];
    for k in (0..marked.len()).filter(|k| marked[*k]) {
        let block = (k / width / side) * across + k % width / side;
        (best[block], has[block]) = (best[block].min(rank.of(k, width)), true);
    }
    let all = has.into_iter().zip(best).enumerate().filter(|(_, (has, _))| *has);
    all.map(|(block, (_, rank))| ([block % across, block / across], rank)).collect()
}

/// A connected part of the marked samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Patch {
    /// Number of its samples.
    pub samples: usize,
    /// The index of its best sample.
    pub best: usize,
    /// The rank of that sample.
    pub rank: f64,
}

/// The connected parts of the marked samples of a grid that is `width` samples wide, in the order of their first
/// samples. Samples are connected to their eight neighbors. The best sample of a part is the one with the smallest
/// rank, of equal ones the first. Samples without a rank count, but are not the best; a part without ranks is left out.
/// `marked` is cleared.
fn patches(marked: &mut [bool], width: usize, rank: impl Fn(usize) -> Option<f64>) -> Vec<Patch> {
    let height = marked.len().checked_div(width).unwrap_or(0);
    let mut found = Vec::new();
    let mut open = Vec::new();
    for first in 0..marked.len() {
        if !std::mem::take(&mut marked[first]) {
            continue;
        }
        let (mut samples, mut best) = (0, None);
        open.push(first);
        while let Some(k) = open.pop() {
            samples += 1;
            if let Some(rank) = rank(k) {
                let own = (rank, k);
                best = Some(best.map_or(own, |other: (f64, usize)| {
                    if own.0.total_cmp(&other.0).then(own.1.cmp(&other.1)).is_lt() { own } else { other }
                }));
            }
            let (i, j) = (k % width, k / width);
            for y in j.saturating_sub(1)..(j + 2).min(height) {
                for x in i.saturating_sub(1)..(i + 2).min(width) {
                    if std::mem::take(&mut marked[y * width + x]) {
                        open.push(y * width + x);
                    }
                }
            }
        }
        found.extend(best.map(|(rank, best)| Patch { samples, best, rank }));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Window;

    fn of(rows: &[&str], rank: impl Fn(usize) -> Option<f64>) -> Vec<(usize, usize)> {
        let mut marked: Vec<bool> = rows.iter().flat_map(|row| row.bytes().map(|byte| byte == b'x')).collect();
        let found = patches(&mut marked, rows[0].len(), rank);
        assert!(!marked.contains(&true));
        found.iter().map(|patch| (patch.samples, patch.best)).collect()
    }

    #[test]
    fn parts_are_connected_by_eight_neighbors() {
        let rows = ["x..xx", ".x..x", "....x", "x...."];
        assert_eq!(of(&rows, |k| Some(k as f64)), [(2, 0), (4, 3), (1, 15)]);
        assert_eq!(of(&rows, |k| Some(-(k as f64))), [(2, 6), (4, 14), (1, 15)]);
        assert_eq!(of(&rows, |_| Some(0.0)), [(2, 0), (4, 3), (1, 15)]);
    }

    #[test]
    fn only_ranked_samples_are_the_best() {
        let rows = ["xx..", "..xx"];
        assert_eq!(of(&rows, |k| (k == 7).then_some(1.0)), [(4, 7)]);
        assert_eq!(of(&rows, |_| None), []);
        assert_eq!(of(&["...."], |_| Some(0.0)), []);
        assert_eq!(patches(&mut [], 0, |_| Some(0.0)), []);
    }

    fn grid(values: &[f32]) -> Grid {
        Grid::from_data(Window::new(4, values.len() / 4, 1.0), values.to_vec()).unwrap()
    }

    #[test]
    fn samples_are_marked_by_bounds() {
        let heights = grid(&[1.0, 2.0, 3.0, f32::NAN]);
        let bounds = |range: [f64; 2], is_within| marked(&[(&heights, Bounds { range, is_within })]);
        assert_eq!(bounds([2.0, f64::INFINITY], true), [false, true, true, false]);
        assert_eq!(bounds([2.0, 2.0], false), [true, false, true, false]);
        let both = [[2.0, 9.0], [0.0, 2.0]].map(|range| (&heights, Bounds { range, is_within: true }));
        assert_eq!(marked(&both), [false, true, false, false]);
        assert!(marked(&[]).is_empty());
    }

    #[test]
    fn the_best_sample_is_the_nearest_or_the_largest_of_the_part() {
        let heights = grid(&[5.0, 1.0, 1.0, 9.0, 1.0, 1.0, 7.0, 1.0]);
        let all = vec![true; 8];
        let best = |columns: Range<usize>, rank| parts(all.clone(), 4, [columns, 0..2], rank)[0].best;
        assert_eq!(best(0..4, Rank::Largest(&heights)), 3);
        assert_eq!(best(0..3, Rank::Largest(&heights)), 6);
        assert_eq!(best(0..4, Rank::Nearest([0.2, 3.0])), 4);
        let found = blocks(&all, 4, 2, Rank::Largest(&heights));
        assert_eq!(found, [([0, 0], -5.0), ([1, 0], -9.0)]);
        let some = [false, false, false, false, false, false, false, true];
        assert_eq!(blocks(&some, 4, 2, Rank::Nearest([3.0, 0.0])), [([1, 0], 1.0)]);
    }
}
