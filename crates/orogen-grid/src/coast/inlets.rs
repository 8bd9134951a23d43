//! Inlets: channels that rivers keep open between a lagoon and the sea.

use super::march::neighbors;
use crate::grid::Window;
use std::collections::{BTreeMap, VecDeque};

/// Depth of inlets, in metres.
const DEPTH: f32 = 1.5;
/// A river ends in a lagoon if its mouth was as many cells from it, at most.
const MOUTH: usize = 3;

/// Cuts channels through sand that closes water into which a river flows. `mouths` are cells at which rivers end.
pub(super) fn open(window: &Window, worn: &[f32], sand: &mut [f32], mouths: impl Iterator<Item = usize>) {
    let mut open = flooded(window, |cell| worn[cell] + sand[cell] < 0.0);
    let reached = flooded(window, |cell| worn[cell] < 0.0);
    for mouth in mouths {
        let Some(start) =
            enclosed_at(window, mouth, |cell| worn[cell] + sand[cell] < 0.0 && reached[cell] && !open[cell])
        else {
            continue;
        };
        for cell in way_out(window, start, &open, |cell| worn[cell] < 0.0, |cell| sand[cell] > 0.0) {
            let wide = neighbors(window, cell).into_iter().flatten().chain([cell]);
            wide.for_each(|cell| sand[cell] = sand[cell].min((-DEPTH - worn[cell]).max(0.0)));
        }
        spread(window, &mut open, vec![start], |cell| worn[cell] + sand[cell] < 0.0);
    }
}

/// The water that is joined to the border.
fn flooded(window: &Window, wet: impl Fn(usize) -> bool) -> Vec<bool> {
    let border = (0..window.len()).filter(|cell| wet(*cell) && neighbors(window, *cell).contains(&None));
    let mut open = vec![false; window.len()];
    spread(window, &mut open, border.collect(), wet);
    open
}

/// Marks the water around some cells.
fn spread(window: &Window, open: &mut [bool], mut queue: Vec<usize>, wet: impl Fn(usize) -> bool) {
    queue.iter().for_each(|cell| open[*cell] = true);
    while let Some(cell) = queue.pop() {
        for next in around(window, cell, 1) {
            if wet(next) && !open[next] {
                open[next] = true;
                queue.push(next);
            }
        }
    }
}

/// The enclosed cell nearest to the mouth of a river.
fn enclosed_at(window: &Window, mouth: usize, enclosed: impl Fn(usize) -> bool) -> Option<usize> {
    (0..=MOUTH).find_map(|far| around(window, mouth, far).find(|cell| enclosed(*cell)))
}

/// The cells within some columns and rows of a cell. Water flows to all eight neighbors.
fn around(window: &Window, cell: usize, far: usize) -> impl Iterator<Item = usize> + use<> {
    let Window { width, height, .. } = *window;
    let (i, j) = (cell % width, cell / width);
    let near = move |at: usize, side: usize| at.saturating_sub(far)..(at + far + 1).min(side);
    near(j, height).flat_map(move |y| near(i, width).map(move |x| y * width + x))
}

/// The cells of the way with the least sand from enclosed water to the sea.
fn way_out(
    window: &Window,
    start: usize,
    open: &[bool],
    passable: impl Fn(usize) -> bool,
    sandy: impl Fn(usize) -> bool,
) -> Vec<usize> {
    let mut from = BTreeMap::new();
    let mut queue = VecDeque::from([(start, start)]);
    while let Some((cell, before)) = queue.pop_front() {
        if from.contains_key(&cell) {
            continue;
        }
        from.insert(cell, before);
        if open[cell] {
            let mut way = vec![cell];
            let mut at = cell;
            while at != start {
                at = from[&at];
                way.push(at);
            }
            return way;
        }
        for next in around(window, cell, 1) {
            if !from.contains_key(&next) && passable(next) {
                // Water first.
                if sandy(next) { queue.push_back((next, cell)) } else { queue.push_front((next, cell)) }
            }
        }
    }
    Vec::new()
}
