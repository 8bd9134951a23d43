//! Fine heights from coarse ones, row by row.

use super::convolution::Row;
use super::cubic::interpolated;
use super::features::{self, Features};
use super::rivers::Rivers;
use super::weights::{self, FEATURES, NOISES, PHASES, Weights};
use crate::error::{Error, ErrorKind, Result};
use crate::grid::{Grid, Window};
use crate::progress::Progress;
use orogen_simd::dispatch;
use std::sync::OnceLock;

/// The fine cell, in metres, at which the octave is 0.
const CELL: f64 = 75.0;

/// A network that makes heights at half the cell of given ones.
#[derive(Debug, Clone, PartialEq)]
pub struct Network {
    pub(super) weights: Weights,
}

/// Which of the lands that fit the coarse heights is made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Draw {
    /// Seed of the noise.
    pub seed: u64,
    /// Number of halvings before; each has a noise of its own.
    pub level: usize,
    /// Factor of the noise: 0 makes the most likely heights, 1 the look of real land.
    pub noise: f32,
}

impl Network {
    /// The network whose weights are part of the program.
    ///
    /// # Errors
    /// If the program was built with a broken file of weights.
    pub fn built_in() -> Result<&'static Network> {
        static NETWORK: OnceLock<Result<Network>> = OnceLock::new();
        NETWORK.get_or_init(|| Network::parse(include_bytes!("land.network"))).as_ref().map_err(Clone::clone)
    }

    /// The network of [`Network::hillslopes`] whose weights are part of the program.
    ///
    /// # Errors
    /// If the program was built with a broken file of weights.
    pub fn built_in_of_rivers() -> Result<&'static Network> {
        static NETWORK: OnceLock<Result<Network>> = OnceLock::new();
        NETWORK.get_or_init(|| Network::parse(include_bytes!("rivers.network"))).as_ref().map_err(Clone::clone)
    }

    /// A network from a file of weights.
    ///
    /// # Errors
    /// If the file is none of a network, of another format, incomplete, or changed.
    pub fn parse(file: &[u8]) -> Result<Network> {
        Ok(Network { weights: Weights::parse(file)? })
    }

    /// Whether the network keeps rivers, for [`Network::hillslopes`].
    #[must_use]
    pub fn keeps_rivers(&self) -> bool {
        self.weights.rivers
    }

    /// Number of coarse samples that a fine one reads on each side.
    #[must_use]
    pub fn halo(&self) -> usize {
        features::REACH + self.weights.layers.len()
    }

    /// Memory that [`Network::refine`] needs beside its result, for coarse heights of this size, in bytes.
    #[must_use]
    pub fn scratch(&self, width: usize, height: usize) -> u64 {
        // Planes: smooth heights and squares with the rows of a pass each, and six features.
        let planes = (width as u64).saturating_mul(height as u64).saturating_mul(10 * 4);
        let rows = (4 * self.rows_in_memory() * self.weights.channels) as u64;
        let rows = rows.saturating_mul(width as u64);
        planes.saturating_add(rows)
    }

    /// What the network sees of the cell of the coarse heights: half the binary logarithm of the fine cell over 75 m.
    pub(super) fn octave(&self, coarse: f64) -> f32 {
        let [least, greatest] = self.weights.cells;
        (0.5 * libm::log2((0.5 * coarse).clamp(least, greatest) / CELL)) as f32
    }

    fn rows_in_memory(&self) -> usize {
        3 * self.weights.layers.len() + 1
    }

    /// The heights of `window`, whose cell is half that of the coarse heights. Sample 2 i of the window is at coarse
    /// sample i, and coarse samples up to [`Network::halo`] from there are read.
    ///
    /// # Errors
    /// If the coarse heights cover too little, or the work is cancelled.
    pub fn refine(&self, coarse: &Grid, window: &Window, draw: &Draw, progress: &Progress) -> Result<Grid> {
        if window.is_empty() {
            return Ok(Grid::filled(*window, 0.0));
        }
        let reach = self.halo();
        let nodes = nodes_of(window, coarse.window().cell);
        let read = nodes.grown(reach);
        let coarse = coarse.crop(&read).ok_or_else(|| {
            Error::new(ErrorKind::Internal, format!("learned detail reads {read:?}, and has {:?}", coarse.window()))
        })?;
        progress.expect(nodes.height as f64);
        let mut out = Grid::filled(*window, 0.0);
        let mut layers = Layers::new(self, &coarse, draw, None)?;
        for j in 0..nodes.height {
            layers.rows(j, &nodes, &mut out);
            progress.step(1.0)?;
        }
        Ok(out)
    }
}

/// The coarse samples at, or to the north-west of, the samples of a window.
pub fn nodes_of(window: &Window, cell: f64) -> Window {
    let [x, y] = [window.x, window.y].map(|first| first.div_euclid(2));
    let [right, bottom] = [window.right(), window.bottom()].map(|end| (end - 1).div_euclid(2) + 1);
    Window { x, y, width: (right - x) as usize, height: (bottom - y) as usize, cell }
}

/// The layers of a network; each keeps the last three rows that it made.
pub struct Layers<'a> {
    network: &'a Network,
    coarse: &'a Grid,
    features: Features,
    rivers: Option<&'a Rivers>,
    draw: &'a Draw,
    octave: f32,
    /// Rows of the features and of each layer, by their number modulo 3, and how many were made.
    kept: Vec<[Vec<f32>; 3]>,
    made: Vec<usize>,
    /// The residuals of the last row, for each node.
    residuals: Vec<[f32; PHASES]>,
}

impl<'a> Layers<'a> {
    /// The layers over coarse heights.
    ///
    /// # Errors
    /// If the network reads rivers and there are none, or the other way round.
    pub fn new(
        network: &'a Network,
        coarse: &'a Grid,
        draw: &'a Draw,
        rivers: Option<&'a Rivers>,
    ) -> Result<Layers<'a>> {
        let Weights { channels, layers, .. } = &network.weights;
        match (network.weights.rivers, rivers) {
            (true, None) => return Err(other_network("keeps rivers: use it in `hillslopes`")),
            (false, Some(_)) => return Err(other_network("reads no rivers: use it in `learned`")),
            _ => {}
        }
        let features = Features::of(coarse);
        let octave = network.octave(coarse.window().cell);
        let row = |layer: usize| {
            let values = if layer == 0 { weights::inputs(network.weights.rivers) } else { *channels };
            std::array::from_fn(|_| vec![0.0; (features.width - 2 * layer) * values])
        };
        let kept = (0..=layers.len()).map(row).collect();
        let nodes = features.width - 2 * layers.len();
        let residuals = vec![[0.0; PHASES]; nodes];
        Ok(Layers { network, coarse, features, rivers, draw, octave, kept, made: vec![0; layers.len() + 1], residuals })
    }

    /// Writes the heights of the fine samples at, and south of, a row of nodes, where `out` has them. Rows are made in
    /// order.
    pub fn rows(&mut self, j: usize, nodes: &Window, out: &mut Grid) {
        self.residuals_of(j);
        let window = *out.window();
        for phase in 0..2 {
            let y = 2 * (nodes.y + j as i64) + phase as i64;
            if let Some(row) = usize::try_from(y - window.y).ok().filter(|row| *row < window.height) {
                self.fine(j, phase, window.x - 2 * nodes.x, out.row_mut(row));
            }
        }
    }

    /// A row of fine samples from sample `first`, counted from the first node: those at a row of nodes (phase 0), or
    /// between it and the next one (phase 1).
    fn fine(&self, j: usize, phase: usize, first: i64, out: &mut [f32]) {
        let cell = self.coarse.window().cell as f32;
        let (reach, width) = (self.network.halo(), self.features.width);
        // The features begin at this node of theirs.
        let inset = reach - features::REACH;
        let nodes = [0, 1].map(|below| (j + inset + below) * width + inset);
        for (sample, out) in (first as usize..).zip(out) {
            let (i, east) = (sample / 2, sample % 2);
            let [scale, calm] = [&self.features.scale, &self.features.calm].map(|plane| {
                let [north, south] = nodes.map(|at| between(plane[at + i], plane[at + i + 1], east));
                between(north, south, phase)
            });
            let residual = self.residuals[i][2 * phase + east];
            let smooth = interpolated(self.coarse, [i + reach, j + reach], [east, phase]);
            *out = smooth + residual * scale * (1.0 - calm) * 0.5 * cell;
        }
    }

    /// Makes the residuals of a row of nodes, in units of the scale.
    fn residuals_of(&mut self, j: usize) {
        let last = self.network.weights.layers.len();
        self.make(last, j);
        let Weights { channels, phases, offsets, .. } = &self.network.weights;
        let values = self.kept[last][j % 3].chunks_exact(*channels);
        for (out, values) in self.residuals.iter_mut().zip(values) {
            let mut sums = *offsets;
            for (value, weights) in values.iter().zip(phases) {
                sums.iter_mut().zip(weights).for_each(|(sum, weight)| *sum += weight * value);
            }
            *out = sums;
        }
    }

    /// Makes the rows of a layer up to row `j`.
    fn make(&mut self, layer: usize, j: usize) {
        while self.made[layer] <= j {
            let row = self.made[layer];
            let mut out = std::mem::take(&mut self.kept[layer][row % 3]);
            if let Some(above) = layer.checked_sub(1) {
                self.make(above, row + 2);
                let inputs = [row, row + 1, row + 2].map(|row| self.kept[above][row % 3].as_slice());
                let is_residual = above > 0;
                dispatch(Row { layer: &self.network.weights.layers[above], inputs, is_residual, out: &mut out });
            } else {
                let read = self.coarse.window();
                let [x, y] = [read.x, read.y + row as i64].map(|first| first + features::REACH as i64);
                let Draw { seed, level, noise } = *self.draw;
                let noise_at = |i: usize| match noise {
                    0.0 => [0.0; NOISES],
                    _ => features::noise(seed, level, x + i as i64, y).map(|value| noise * value),
                };
                let values = weights::inputs(self.network.weights.rivers);
                self.features.row(row, self.octave, noise_at, values, &mut out);
                if let Some(rivers) = self.rivers {
                    for (i, out) in out.chunks_exact_mut(values).enumerate() {
                        let of_rivers = rivers.of_node(self.coarse, &self.features, i, row);
                        out[FEATURES + NOISES..].copy_from_slice(&of_rivers);
                    }
                }
            }
            self.kept[layer][row % 3] = out;
            self.made[layer] += 1;
        }
    }
}

fn other_network(what: &str) -> Error {
    Error::new(ErrorKind::Recipe, format!("the network of `weights` {what}"))
}

/// The first of two values, or their mean.
fn between(first: f32, second: f32, phase: usize) -> f32 {
    if phase == 0 { first } else { (first + second) * 0.5 }
}
