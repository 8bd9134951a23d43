//! What a network sees of coarse heights, in units of the slope around each node.

use super::weights::{FEATURES, NOISES};
use crate::grid::Grid;
use crate::multiscale::hash;

/// Passes of the binomial filter that makes the scale of slopes and the smooth heights.
pub const PASSES: usize = 4;
/// Nodes that the features of a node read on each side: one for its slope, and the passes.
pub const REACH: usize = PASSES + 1;
/// Square of the slope below which ground counts as level.
pub const LEVEL: f32 = 4e-4;

/// The features of the nodes of heights that are at least [`REACH`] nodes from their border.
pub struct Features {
    /// Number of nodes in a row.
    pub width: usize,
    /// Scale of slopes.
    pub scale: Vec<f32>,
    /// 1 where there is standing water, whose heights are all equal; 0 elsewhere.
    pub calm: Vec<f32>,
    east: Vec<f32>,
    south: Vec<f32>,
    bend: Vec<f32>,
    above: Vec<f32>,
}

impl Features {
    /// The features of heights in metres, whose window is wider and higher than twice the reach.
    pub fn of(heights: &Grid) -> Features {
        let (columns, rows) = (heights.width(), heights.height());
        let (width, height) = (columns - 2 * REACH, rows - 2 * REACH);
        let z = heights.data();
        let per_cell = (1.0 / heights.window().cell) as f32;
        let half = 0.5 * per_cell;
        let slopes = |at: usize| [(z[at + 1] - z[at - 1]) * half, (z[at + columns] - z[at - columns]) * half];

        let inside = (1..rows - 1).flat_map(|j| (1..columns - 1).map(move |i| j * columns + i));
        let squares =
            inside.map(|at| slopes(at).map(|slope| slope * slope)).map(|[east, south]| east + south).collect();
        let scale = binomial(squares, columns - 2).into_iter().map(|square| (square + LEVEL).sqrt()).collect();
        let smooth = binomial(z.to_vec(), columns);
        let empty = || Vec::with_capacity(width * height);
        let mut features =
            Features { width, scale, calm: empty(), east: empty(), south: empty(), bend: empty(), above: empty() };
        for j in 0..height {
            let first = (j + REACH) * columns + REACH;
            let smooth = &smooth[(j + 1) * (columns - 2 * PASSES) + 1..][..width];
            for ((at, scale), smooth) in (first..).zip(&features.scale[j * width..][..width]).zip(smooth) {
                let [east, south] = slopes(at);
                let around = [at + 1, at - 1, at + columns, at - columns].map(|near| z[near] - z[at]);
                let bend = (around[0] + around[1] + around[2] + around[3]) * 0.25;
                let corners = [at - columns - 1, at - columns + 1, at + columns - 1, at + columns + 1];
                let is_calm = around == [0.0; 4] && corners.map(|near| z[near]) == [z[at]; 4];
                features.east.push(east / scale);
                features.south.push(south / scale);
                features.bend.push(bend * per_cell / scale * 3.0);
                features.above.push((z[at] - smooth) * per_cell / scale);
                features.calm.push(f32::from(u8::from(is_calm)));
            }
        }
        features
    }

    /// Writes the features and the noise of the nodes of a row, node by node, each of which has this number of values.
    pub fn row(
        &self,
        j: usize,
        octave: f32,
        mut noise: impl FnMut(usize) -> [f32; NOISES],
        values: usize,
        out: &mut [f32],
    ) {
        let here = j * self.width..(j + 1) * self.width;
        for ((i, at), out) in here.enumerate().zip(out.chunks_exact_mut(values)) {
            let scale = libm::logf(self.scale[at]) + 1.0;
            let (of_heights, of_noise) = out[..FEATURES + NOISES].split_at_mut(FEATURES);
            let [east, south] = [self.east[at], self.south[at]];
            of_heights.copy_from_slice(&[east, south, self.bend[at], self.above[at], scale, octave]);
            of_noise.copy_from_slice(&noise(i));
        }
    }
}

/// The noise of a node of a level: numbers with a nearly normal distribution and a variance of 1.
pub fn noise(seed: u64, level: usize, x: i64, y: i64) -> [f32; NOISES] {
    std::array::from_fn(|plane| hash::normal(hash::node(seed, level, x, y, plane as u64)))
}

/// Values filtered with [1 2 1] / 4 along rows and columns; each pass takes one node from each side.
fn binomial(mut values: Vec<f32>, mut width: usize) -> Vec<f32> {
    let mut rows = Vec::new();
    for _ in 0..PASSES {
        let narrow = width - 2;
        rows.clear();
        for row in values.chunks_exact(width) {
            let three = row.iter().zip(&row[1..]).zip(&row[2..]);
            rows.extend(three.map(|((a, b), c)| (a + 2.0 * b + c) * 0.25));
        }
        values.clear();
        let three = rows.iter().zip(&rows[narrow..]).zip(&rows[2 * narrow..]);
        values.extend(three.map(|((a, b), c)| (a + 2.0 * b + c) * 0.25));
        width = narrow;
    }
    values
}
