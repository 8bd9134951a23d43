//! Fast marching: the time at which a front reaches each cell (Sethian 1996), with values that it carries along
//! (Adalsteinsson and Sethian 1999).

use crate::grid::Window;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// A cell at which a front begins.
pub(super) struct Start {
    pub(super) cell: usize,
    pub(super) time: f64,
    pub(super) carried: [f32; 2],
}

/// Where a front came by.
pub(super) struct Front {
    /// Time of each cell, or infinity.
    pub(super) time: Vec<f32>,
    pub(super) carried: Vec<[f32; 2]>,
}

/// The four neighbors of a cell: west, east, north, south.
pub(super) fn neighbors(window: &Window, cell: usize) -> [Option<usize>; 4] {
    let (i, j) = (cell % window.width, cell / window.width);
    [
        (i > 0).then(|| cell - 1),
        (i + 1 < window.width).then(|| cell + 1),
        (j > 0).then(|| cell - window.width),
        (j + 1 < window.height).then(|| cell + window.width),
    ]
}

/// A front from `starts` through the cells that are `open`, until `limit`. Times are 0 or more. `slowness` is the time
/// for a metre at a cell, given what the front carries.
pub(super) fn march(
    window: &Window,
    starts: Vec<Start>,
    open: impl Fn(usize) -> bool,
    slowness: impl Fn(usize, [f32; 2]) -> f64,
    limit: f64,
) -> Front {
    let mut front = Front { time: vec![f32::INFINITY; window.len()], carried: vec![[0.0; 2]; window.len()] };
    let mut done = vec![false; window.len()];
    let mut queue = BinaryHeap::new();
    for start in starts {
        let time = start.time as f32;
        if time < front.time[start.cell] {
            front.time[start.cell] = time;
            front.carried[start.cell] = start.carried;
            queue.push(Reverse((time.to_bits(), start.cell)));
        }
    }
    while let Some(Reverse((bits, cell))) = queue.pop() {
        // Times are not negative, so their bits have their order.
        if done[cell] || bits != front.time[cell].to_bits() {
            continue;
        }
        if f64::from(f32::from_bits(bits)) > limit {
            break;
        }
        done[cell] = true;
        for next in neighbors(window, cell).into_iter().flatten() {
            if done[next] || !open(next) {
                continue;
            }
            let (time, carried) = arrive(window, &front, &done, next, &slowness);
            if time < front.time[next] {
                front.time[next] = time;
                front.carried[next] = carried;
                queue.push(Reverse((time.to_bits(), next)));
            }
        }
    }
    front
}

/// The time at which the front reaches a cell from its neighbors, and what it carries there.
fn arrive(
    window: &Window,
    front: &Front,
    done: &[bool],
    cell: usize,
    slowness: &impl Fn(usize, [f32; 2]) -> f64,
) -> (f32, [f32; 2]) {
    let [west, east, north, south] = neighbors(window, cell);
    let earlier = |a: Option<usize>, b: Option<usize>| {
        let time = |at: Option<usize>| match at {
            Some(at) if done[at] => (f64::from(front.time[at]), front.carried[at]),
            _ => (f64::INFINITY, [0.0; 2]),
        };
        let (a, b) = (time(a), time(b));
        if b.0 < a.0 { b } else { a }
    };
    let (mut first, mut second) = (earlier(west, east), earlier(north, south));
    if second.0 < first.0 {
        std::mem::swap(&mut first, &mut second);
    }
    let step = window.cell * slowness(cell, first.1);
    let apart = second.0 - first.0;
    if apart >= step || !step.is_finite() {
        return ((first.0 + step) as f32, first.1);
    }
    let time = 0.5 * (first.0 + second.0 + (2.0 * step * step - apart * apart).sqrt());
    // Carried values do not change along the way of the front.
    let (by_first, by_second) = (time - first.0, time - second.0);
    let share = (by_second / (by_first + by_second).max(f64::MIN_POSITIVE)) as f32;
    (time as f32, [0, 1].map(|k| first.1[k] + share * (second.1[k] - first.1[k])))
}
