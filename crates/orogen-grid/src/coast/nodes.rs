//! The shore as lines of nodes.

use super::march::neighbors;
use crate::contour::trace::contours;
use crate::error::Result;
use crate::grid::{Grid, Window};
use std::collections::VecDeque;

/// Distance between nodes, in cells.
const SPACING: f64 = 2.5;
/// No cell.
pub(super) const NONE: u32 = u32::MAX;

/// A place on the shore.
#[derive(Debug, Clone, Copy)]
pub(super) struct Node {
    /// Cells east and south of the first sample.
    pub(super) at: [f64; 2],
    /// Unit vector out to sea.
    pub(super) out: [f64; 2],
    /// Distance to the next node, in metres.
    pub(super) length: f64,
    /// Length of the whole line, or infinity if it leaves the window, in metres.
    pub(super) line: f64,
    /// The first node of the line.
    pub(super) first: usize,
    /// The node before and after along the line.
    pub(super) ends: [usize; 2],
}

/// The shore as lines of nodes.
pub(super) struct Nodes {
    pub(super) nodes: Vec<Node>,
    /// The nearest node of each cell, or [`NONE`].
    pub(super) nearest: Vec<u32>,
}

impl Nodes {
    /// Nodes along the line where `shore` is 0; it is positive on land.
    pub(super) fn new(window: &Window, shore: &[f32], reach: usize) -> Result<Nodes> {
        let limit = 2.0 * window.cell as f32;
        // Positions count from the window, so that precision does not depend on its place.
        let local = Window::new(window.width, window.height, 1.0);
        let data = shore.iter().map(|shore| if *shore > 0.0 { shore.min(limit) } else { shore.clamp(-limit, -1e-6) });
        let mut nodes = Vec::new();
        if let Some(grid) = Grid::from_data(local, data.collect()) {
            for line in contours(&grid, &[0.0])? {
                let path: Vec<[f64; 2]> = line.path().collect();
                resample(&path, line.closed, window.cell, &mut nodes);
            }
        }
        let nearest = nearest(window, &nodes, reach);
        Ok(Nodes { nodes, nearest })
    }
}

/// Adds evenly spaced nodes of a line.
fn resample(path: &[[f64; 2]], closed: bool, cell: f64, nodes: &mut Vec<Node>) {
    let between = |[ax, ay]: [f64; 2], [bx, by]: [f64; 2]| ((bx - ax) * (bx - ax) + (by - ay) * (by - ay)).sqrt();
    let total: f64 = path.windows(2).map(|pair| between(pair[0], pair[1])).sum();
    let count = (total / SPACING) as usize;
    if count < 4 {
        return;
    }
    let line = if closed { total * cell } else { f64::INFINITY };
    let first = nodes.len();
    let step = total / count as f64;
    let (mut gone, mut next) = (0.0, 0.5 * step);
    let mut points: Vec<[f64; 2]> = Vec::with_capacity(count);
    for pair in path.windows(2) {
        let length = between(pair[0], pair[1]);
        while next <= gone + length && points.len() < count {
            let share = (next - gone) / length.max(f64::MIN_POSITIVE);
            points.push([0, 1].map(|k| pair[0][k] + share * (pair[1][k] - pair[0][k])));
            next += step;
        }
        gone += length;
    }
    let count = points.len();
    let beside = |k: usize, by: isize| {
        let at = k as isize + by;
        if closed { at.rem_euclid(count as isize) as usize } else { at.clamp(0, count as isize - 1) as usize }
    };
    for (k, at) in points.iter().enumerate() {
        let (from, to) = (points[beside(k, -2)], points[beside(k, 2)]);
        let [x, y] = [to[0] - from[0], to[1] - from[1]];
        let length = (x * x + y * y).sqrt().max(f64::MIN_POSITIVE);
        // Land is to the left of the line with north up, so the sea is to the right.
        let out = [-y / length, x / length];
        let ends = [first + beside(k, -1), first + beside(k, 1)];
        nodes.push(Node { at: *at, out, length: step * cell, line, first, ends });
    }
}

/// The nearest node of each cell, by steps from cell to cell, up to `reach` cells away.
fn nearest(window: &Window, nodes: &[Node], reach: usize) -> Vec<u32> {
    let mut nearest = vec![NONE; window.len()];
    let mut queue = VecDeque::new();
    for (k, node) in nodes.iter().enumerate() {
        let cell = cell_of(window, node.at);
        if nearest[cell] == NONE {
            nearest[cell] = k as u32;
            queue.push_back((cell, 0));
        }
    }
    while let Some((cell, steps)) = queue.pop_front() {
        if steps >= reach {
            continue;
        }
        for next in neighbors(window, cell).into_iter().flatten() {
            if nearest[next] == NONE {
                nearest[next] = nearest[cell];
                queue.push_back((next, steps + 1));
            }
        }
    }
    nearest
}

/// The cell nearest to a position in cells.
pub(super) fn cell_of(window: &Window, [x, y]: [f64; 2]) -> usize {
    let nearest = |at: f64, side: usize| (at + 0.5).clamp(0.0, side as f64 - 1.0) as usize;
    nearest(y, window.height) * window.width + nearest(x, window.width)
}
