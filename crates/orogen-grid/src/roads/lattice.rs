//! The lattice of routes: its nodes, where they may be, and the moves between them.

use super::moves::MoveSet;
use super::{Land, Roads};
use crate::grid::Window;
use crate::parallel;

/// Cells per node along an axis.
fn step_of(cell: f64, spacing: f64) -> usize {
    (spacing / cell).round().clamp(1.0, 1e6) as usize
}

fn count(samples: usize, step: usize) -> usize {
    samples.saturating_sub(1) / step + 1
}

/// Number of nodes over a window.
pub(super) fn nodes_of(window: &Window, spacing: f64) -> usize {
    let step = step_of(window.cell, spacing);
    count(window.width, step).saturating_mul(count(window.height, step))
}

/// The nodes.
pub(super) struct Lattice {
    /// The samples of the ground.
    pub(super) window: Window,
    /// Samples from a node to the next.
    pub(super) step: usize,
    /// Distance between nodes, in metres.
    pub(super) spacing: f64,
    /// Columns and rows of nodes.
    pub(super) size: [usize; 2],
    /// Whether a sample is water, or has no height.
    pub(super) wet: Vec<bool>,
    /// Whether a road may not be at a sample: water, and the samples beside it.
    pub(super) blocked: Vec<bool>,
    /// Heights of the nodes, in metres, means around them.
    pub(super) heights: Vec<f32>,
    /// The moves from each node.
    pub(super) moves: MoveSet,
}

impl Lattice {
    pub(super) fn new(roads: &Roads, land: &Land) -> Lattice {
        let window = *land.ground.window();
        let step = step_of(window.cell, roads.spacing);
        let spacing = step as f64 * window.cell;
        let size = [count(window.width, step), count(window.height, step)];
        let wet = parallel::samples(window.len(), |cell| {
            let height = land.ground.data()[cell];
            let is_water = land.water.is_some_and(|water| water.data()[cell] > 0.0);
            let is_barred = land.cost.is_some_and(|cost| cost.data()[cell].is_nan());
            !height.is_finite() || is_water || is_barred || land.sea_level.is_some_and(|sea| height <= sea)
        });
        let beside = (0.5 * roads.width / window.cell).round().clamp(1.0, 64.0) as usize;
        let blocked = grown(&window, &wet, beside);
        let mut lattice = Lattice {
            window,
            step,
            spacing,
            size,
            wet,
            blocked,
            heights: Vec::new(),
            moves: MoveSet::new(spacing, roads.radius),
        };
        lattice.heights = parallel::samples(lattice.len(), |node| lattice.mean(land, node));
        lattice
    }

    /// Number of nodes.
    pub(super) fn len(&self) -> usize {
        self.size[0] * self.size[1]
    }

    /// Column and row of a node.
    pub(super) fn place(&self, node: usize) -> [i32; 2] {
        [(node % self.size[0]) as i32, (node / self.size[0]) as i32]
    }

    /// The node at a column and row.
    pub(super) fn node(&self, [column, row]: [i32; 2]) -> Option<usize> {
        let inside = |at: i32, count: usize| at >= 0 && (at as usize) < count;
        (inside(column, self.size[0]) && inside(row, self.size[1]))
            .then(|| row as usize * self.size[0] + column as usize)
    }

    /// The sample at a node.
    pub(super) fn sample(&self, node: usize) -> usize {
        let [column, row] = [node % self.size[0], node / self.size[0]];
        row * self.step * self.window.width + column * self.step
    }

    /// The position of a node: metres east and south of the first sample. All positions are relative to it, so that
    /// roads do not depend on the distance from the world's origin.
    pub(super) fn position(&self, node: usize) -> [f64; 2] {
        let [column, row] = [node % self.size[0], node / self.size[0]];
        [column, row].map(|at| (at * self.step) as f64 * self.window.cell)
    }

    /// The sample nearest to a position.
    pub(super) fn sample_at(&self, at: [f64; 2]) -> usize {
        let [x, y] = self.columns(at);
        let near = |at: f64, count: usize| (at.round().max(0.0) as usize).min(count.saturating_sub(1));
        near(y, self.window.height) * self.window.width + near(x, self.window.width)
    }

    /// A position in columns and rows of samples.
    pub(super) fn columns(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [x / self.window.cell, y / self.window.cell]
    }

    /// The free node nearest to a position, within some nodes.
    pub(super) fn nearest(&self, at: [f64; 2]) -> Option<usize> {
        const NEAR: i32 = 4;
        let [x, y] = self.columns(at).map(|samples| samples / self.step as f64);
        let [column, row] = [x.round() as i32, y.round() as i32];
        let mut best: Option<(f64, usize)> = None;
        for j in row - NEAR..=row + NEAR {
            for i in column - NEAR..=column + NEAR {
                let Some(node) = self.node([i, j]).filter(|node| !self.blocked[self.sample(*node)]) else { continue };
                let [dx, dy] = [f64::from(i) - x, f64::from(j) - y];
                let square = dx * dx + dy * dy;
                if best.is_none_or(|(least, _)| square < least) {
                    best = Some((square, node));
                }
            }
        }
        best.map(|(_, node)| node)
    }

    /// The mean height around a node; roads are cut and filled at that scale anyway.
    fn mean(&self, land: &Land, node: usize) -> f32 {
        let reach = (self.step / 2) as i64;
        let [column, row] = [node % self.size[0] * self.step, node / self.size[0] * self.step].map(|at| at as i64);
        let own = land.ground.data()[self.sample(node)];
        let (mut sum, mut count) = (0.0f64, 0u32);
        for j in (row - reach).max(0)..=(row + reach).min(self.window.height as i64 - 1) {
            for i in (column - reach).max(0)..=(column + reach).min(self.window.width as i64 - 1) {
                let sample = j as usize * self.window.width + i as usize;
                if !self.wet[sample] {
                    sum += f64::from(land.ground.data()[sample]);
                    count += 1;
                }
            }
        }
        if count > 0 { (sum / f64::from(count)) as f32 } else { own }
    }

    /// The samples on the straight way between two nodes, without its ends, with their shares of the way.
    pub(super) fn between(&self, from: usize, step: [i32; 2]) -> impl Iterator<Item = (usize, f64)> + use<> {
        let [dx, dy] = step.map(|nodes| nodes * self.step as i32);
        let count = dx.abs().max(dy.abs());
        let (first, width) = (self.sample(from) as i64, self.window.width as i64);
        (1..count).map(move |k| {
            // The nearest column and row, ties away from the start.
            let near = |part: i32| {
                let doubled = 2 * i64::from(part.abs()) * i64::from(k) + i64::from(count);
                i64::from(part.signum()) * (doubled / (2 * i64::from(count)))
            };
            let sample = first + near(dy) * width + near(dx);
            (sample as usize, f64::from(k) / f64::from(count))
        })
    }
}

/// A mask with the samples within some columns and rows.
fn grown(window: &Window, mask: &[bool], by: usize) -> Vec<bool> {
    let mut grown = mask.to_vec();
    let mut spread = |lines: usize, line_stride: usize, along: usize, stride: usize| {
        for line in 0..lines {
            let at = |i: usize| line * line_stride + i * stride;
            let marked: Vec<bool> = (0..along).map(|i| grown[at(i)]).collect();
            // The number of samples until which the last mark reaches.
            let mut until = 0;
            for i in 0..(along + by) {
                if i < along && marked[i] {
                    until = i + 2 * by + 1;
                }
                if i >= by && i < until {
                    grown[at(i - by)] = true;
                }
            }
        }
    };
    spread(window.height, window.width, window.width, 1);
    spread(window.width, 1, window.height, window.width);
    grown
}
