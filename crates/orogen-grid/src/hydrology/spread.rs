//! Spreading of the sediment that rivers laid in a step.
//!
//! A river is one cell wide, and lays all that a step brings in these cells. In nature it leaves its bed as soon as
//! that is higher than the ground beside it, many times during a step, and fills the ground on both sides. So the new
//! sediment, and only that, moves to lower neighbors in proportion to the difference of heights.

use super::direction::{is_diagonal, neighbor, strides};
use crate::grid::Grid;
use crate::parallel;

/// Number of passes.
const PASSES: usize = 4;

/// The share of a difference of heights that moves to a side neighbor in a pass; to a corner neighbor moves a half.
const SHARE: f32 = 0.12;

/// The maximum share of a cell's new sediment that moves to a side neighbor in a pass: for all neighbors it is 3/4.
const LIMIT: f32 = 0.125;

/// Moves new sediment; its volume is kept. `fresh` is its thickness, `is_open` 1 for cells that may change and 0 for
/// others. `buffers` avoids new allocations.
pub(super) fn spread(heights: &mut Grid, fresh: &mut Vec<f32>, is_open: &[f32], buffers: &mut [Vec<f32>; 2]) {
    let (width, height) = (heights.width(), heights.height());
    if width < 3 || height < 3 {
        return;
    }
    let [next_heights, next_fresh] = buffers;
    heights.data().clone_into(next_heights);
    fresh.clone_into(next_fresh);
    let count = width - 2;
    for _ in 0..PASSES {
        let (h, f) = (heights.data(), &fresh[..]);
        let rows = next_heights.chunks_mut(width).zip(next_fresh.chunks_mut(width));
        let rows = rows.enumerate().take(height - 1).skip(1);
        parallel::for_each_init(
            rows,
            || vec![0.0f32; count],
            |moved, (j, (next_heights, next_fresh))| {
                let start = j * width + 1;
                let own = start..start + count;
                let (here, own_fresh) = (&h[own.clone()], &f[own.clone()]);
                moved.fill(0.0);
                for (code, stride) in strides(width).into_iter().enumerate() {
                    let weight = if is_diagonal(code as u8) { 0.5 } else { 1.0 };
                    let from = neighbor(start, stride);
                    let range = from..from + count;
                    let theirs = h[range.clone()].iter().zip(&f[range.clone()]).zip(&is_open[range]);
                    for (moved, ((here, fresh), ((there, their_fresh), open))) in
                        moved.iter_mut().zip(here.iter().zip(own_fresh).zip(theirs))
                    {
                        let gain = SHARE * (there - here);
                        // Outlets have no new sediment.
                        let (most, least) = (LIMIT * their_fresh, -LIMIT * open * fresh);
                        let gain = if gain < most { gain } else { most };
                        *moved += weight * if gain > least { gain } else { least };
                    }
                }
                let inner = next_heights[1..=count].iter_mut().zip(&mut next_fresh[1..=count]);
                let own = here.iter().zip(own_fresh).zip(&is_open[own]);
                for ((next_height, next_fresh), (moved, ((height, fresh), open))) in inner.zip(moved.iter().zip(own)) {
                    let moved = open * moved;
                    *next_height = height + moved;
                    *next_fresh = fresh + moved;
                }
            },
        );
        heights.data_mut().swap_with_slice(next_heights);
        std::mem::swap(fresh, next_fresh);
    }
}
