//! The lines of glaciers: the samples that ice passes, with their beds.

use super::{Glaciated, Glaciation, MIN_ICE};
use crate::grid::{Grid, Window};
use crate::hydrology::direction::{DISTANCES, STEPS, strides};
use crate::multiscale::gradient_noise::noise;
use crate::multiscale::hash;

/// No node.
pub const NOWHERE: u32 = u32::MAX;

/// Distance in metres over which beds are smoothed along the valley: a pass at 60 m is 1 of 12.
const SMOOTHED: f64 = 60.0;
const SMOOTH_PASSES: f64 = 12.0;

/// Distance in metres over which a tributary falls to the bed of a trunk that it joins at the same height.
const GRADED: f64 = 1200.0;
/// The slope of such a tributary, in addition to that of its river.
const GRADE: f32 = 0.1;
/// Share of the tributaries that hang.
const HANGING: f32 = 0.5;

/// The depth grows with the ice to this power.
const DEPTH_EXPONENT: f64 = 0.35;

/// The greatest depth below the river, in metres.
const MAX_DEPTH: f64 = 900.0;

/// Mean height of the ground at the half width above the river, in metres, at which a glacier is half confined.
const CONFINING: f32 = 80.0;
/// Largest distance from the river at which that ground is read, in metres.
const AROUND: f32 = 600.0;
/// And in samples.
const MAX_STEPS: f32 = 64.0;

/// Radius in metres of a cirque: the mean, and its variation.
const CIRQUE: f32 = 380.0;
/// Greatest number of samples from the head of a cirque to its lip.
const LIP: usize = 6;

/// The lines of glaciers over a window.
pub struct Beds {
    /// The sample of each node, row-major.
    pub sample: Vec<usize>,
    /// The node downstream, or [`NOWHERE`].
    pub receiver: Vec<u32>,
    /// The node with the most ice among those upstream, or [`NOWHERE`].
    pub donor: Vec<u32>,
    /// Ice in km^2.
    pub ice: Vec<f32>,
    /// Height of the bed in metres.
    pub bed: Vec<f32>,
    /// Half of the width of the trough in metres.
    pub half: Vec<f32>,
    /// Position of the line beside the sample, in samples to the east and south.
    pub aside: Vec<[f32; 2]>,
    /// Radius of a cirque at this node in metres, 0 elsewhere.
    pub cirque: Vec<f32>,
}

fn passes(cell: f64) -> usize {
    (SMOOTH_PASSES * (SMOOTHED / cell) * (SMOOTHED / cell)).round().clamp(1.0, 64.0) as usize
}

fn graded(cell: f64) -> usize {
    (GRADED / cell).round().clamp(1.0, 64.0) as usize
}

/// Number of samples on which a bed depends.
pub fn reach(cell: f64) -> usize {
    1 + (f64::from(AROUND) / cell).ceil().min(f64::from(MAX_STEPS)) as usize + graded(cell) + passes(cell) + 2 * LIP
}

impl Beds {
    /// The lines of the glaciers of a land.
    pub fn new(glaciation: &Glaciation, land: &Glaciated) -> Beds {
        let mut beds = Beds::found(glaciation, land);
        beds.grade(glaciation, land);
        beds.smooth(passes(land.height.window().cell), land.height.width());
        beds.cut_cirques(glaciation, land);
        beds
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.sample.len()
    }

    /// The lines with beds that depend on their own ice alone.
    fn found(glaciation: &Glaciation, land: &Glaciated) -> Beds {
        let (node_of, sample) = samples_of(land);
        let steps = strides(land.height.width());
        let downstream = |q: usize| q.wrapping_add_signed(steps[land.receiver.data()[q] as usize & 7]);
        let receiver: Vec<u32> = sample.iter().map(|q| node_of[downstream(*q)]).collect();
        let ice: Vec<f32> = sample.iter().map(|q| land.ice.data()[*q] * 1e-6).collect();
        let mut donor = vec![NOWHERE; sample.len()];
        for (node, to) in receiver.iter().enumerate() {
            if let Some(donor) = donor.get_mut(*to as usize)
                && (*donor == NOWHERE || ice[node] > ice[*donor as usize])
            {
                *donor = node as u32;
            }
        }
        let half: Vec<f32> = ice.iter().map(|ice| glaciation.half_width(*ice)).collect();
        let nodes = sample.iter().zip(&ice).zip(&half);
        let bed = nodes.map(|((q, ice), half)| {
            let depth = depth(glaciation, land.height.window(), *q, f64::from(*ice));
            land.height.data()[*q] - depth * confinement(land.height, *q, *half)
        });
        let bed = bed.collect();
        let (aside, cirque) = (vec![[0.0; 2]; sample.len()], vec![0.0; sample.len()]);
        Beds { sample, receiver, donor, ice, bed, half, aside, cirque }
    }

    /// Whether a node is the last of a tributary: the trunk has more ice from elsewhere.
    fn joins(&self, node: usize) -> bool {
        let to = self.receiver[node];
        to != NOWHERE && self.donor[to as usize] != node as u32
    }

    /// Whether a tributary hangs over the trunk.
    fn hangs(&self, node: usize, glaciation: &Glaciation, land: &Glaciated) -> bool {
        let (width, window) = (land.height.width(), land.height.window());
        let q = self.sample[node];
        let (x, y) = (window.x + (q % width) as i64, window.y + (q / width) as i64);
        hash::unit(hash::node(glaciation.seed, DEPTH, x, y, 2)) < HANGING
    }

    /// Lowers the beds of tributaries that do not hang to those of the trunks at their mouths.
    fn grade(&mut self, glaciation: &Glaciation, land: &Glaciated) {
        let (cell, heights) = (land.height.window().cell, land.height.data());
        let hangs: Vec<bool> =
            (0..self.len()).map(|node| self.joins(node) && self.hangs(node, glaciation, land)).collect();
        let bounds: Vec<f32> = (0..self.len())
            .map(|node| {
                let to = self.receiver[node];
                if to == NOWHERE || hangs[node] {
                    return f32::INFINITY;
                }
                let q = self.sample[node];
                let code = land.receiver.data()[q] as usize & 7;
                let length = (DISTANCES[code] * cell) as f32;
                (heights[q] - heights[self.sample[to as usize]]).max(0.0) + GRADE * length
            })
            .collect();
        let mut to = self.bed.clone();
        for _ in 0..graded(cell) {
            for node in 0..self.len() {
                let bound = bounds[node];
                if bound < f32::INFINITY {
                    to[node] = self.bed[node].min(self.bed[self.receiver[node] as usize] + bound);
                }
            }
            std::mem::swap(&mut self.bed, &mut to);
        }
    }

    /// Smooths beds, widths and positions along the valleys. A tributary does not mix with its trunk.
    fn smooth(&mut self, passes: usize, width: usize) {
        let place = |q: usize| [(q % width) as f32, (q / width) as f32];
        let joins: Vec<bool> = (0..self.len()).map(|node| self.joins(node)).collect();
        let (mut bed, mut half) = (self.bed.clone(), self.half.clone());
        let mut moved = self.aside.clone();
        for _ in 0..passes {
            for node in 0..self.len() {
                let up = self.donor[node];
                let up = if up == NOWHERE { node } else { up as usize };
                let down = self.receiver[node];
                let down = if down == NOWHERE || joins[node] { node } else { down as usize };
                let mixed = |plane: &[f32]| 0.5 * plane[node] + 0.25 * (plane[down] + plane[up]);
                bed[node] = mixed(&self.bed);
                half[node] = mixed(&self.half);
                if up != node && self.receiver[node] != NOWHERE {
                    let down = self.receiver[node] as usize;
                    let [here, above, below] = [node, up, down].map(|node| place(self.sample[node]));
                    moved[node] = [0, 1].map(|axis| {
                        let of = |node: usize, at: [f32; 2]| self.aside[node][axis] + (at[axis] - here[axis]);
                        0.5 * self.aside[node][axis] + 0.25 * (of(up, above) + of(down, below))
                    });
                }
            }
            std::mem::swap(&mut self.bed, &mut bed);
            std::mem::swap(&mut self.half, &mut half);
            std::mem::swap(&mut self.aside, &mut moved);
        }
        for aside in &mut self.aside {
            *aside = aside.map(|metres| metres.clamp(-3.0, 3.0));
        }
    }

    /// Cuts cirques into the heads of glaciers: the floor some samples downstream is cut back to the head.
    fn cut_cirques(&mut self, glaciation: &Glaciation, land: &Glaciated) {
        let window = land.height.window();
        let (width, cell) = (window.width, window.cell as f32);
        let smoothed = self.bed.clone();
        for node in 0..self.len() {
            let q = self.sample[node];
            if self.donor[node] != NOWHERE || land.height.data()[q] < land.equilibrium_line.data()[q] - 150.0 {
                continue;
            }
            let (x, y) = (window.x + (q % width) as i64, window.y + (q / width) as i64);
            let bits = hash::node(glaciation.seed, DEPTH, x, y, 1);
            if hash::unit16(bits, 0) >= glaciation.cirques as f32 {
                continue;
            }
            let radius = CIRQUE * (0.5 + 0.9 * hash::unit16(bits, 1));
            let links = ((180.0 + 0.4 * radius) / cell).round().clamp(1.0, LIP as f32) as usize;
            let mut path = vec![node];
            for _ in 0..links {
                let last = path[path.len() - 1];
                path.push(if self.receiver[last] == NOWHERE { last } else { self.receiver[last] as usize });
            }
            let base = smoothed[path[links]].max(smoothed[node] - 0.35 * radius);
            let tarn = if hash::unit16(bits, 2) < 0.3 { 16.0 * hash::unit16(bits, 3) } else { -4.0 };
            for (step, &node) in path[..links].iter().enumerate() {
                let lip = if step + 1 < links { tarn } else { 0.0 };
                self.bed[node] = self.bed[node].min(base + 0.02 * cell * (links - step) as f32 - lip);
                // Open downstream.
                let taper = 1.0 - 0.5 * step as f32 / links as f32;
                self.cirque[node] = self.cirque[node].max(radius * taper);
            }
        }
    }
}

/// The samples that ice passes, and the node of each sample or [`NOWHERE`]. Samples on the border have none.
fn samples_of(land: &Glaciated) -> (Vec<u32>, Vec<usize>) {
    let (width, height) = (land.height.width(), land.height.height());
    let mut node_of = vec![NOWHERE; land.height.data().len()];
    let mut sample = Vec::new();
    for j in 1..height.saturating_sub(1) {
        for i in 1..width.saturating_sub(1) {
            let q = j * width + i;
            let flows = (0.0..8.0).contains(&land.receiver.data()[q]);
            if flows && land.ice.data()[q] >= MIN_ICE * 1e6 && land.height.data()[q].is_finite() {
                node_of[q] = sample.len() as u32;
                sample.push(q);
            }
        }
    }
    (node_of, sample)
}

/// Depth below the river at a sample, by its ice in km^2 and noise, in metres.
fn depth(glaciation: &Glaciation, window: &Window, q: usize, ice: f64) -> f32 {
    let place = [window.east(q % window.width), window.south(q / window.width)].map(|metres| metres * 1e-3);
    let noise = |wavelength: f64, stream| {
        let [east, south] = place.map(|km| km / wavelength);
        noise(glaciation.seed, stream, east, south)
    };
    // Basins of larger glaciers are longer. Wavelengths between powers of two are mixed of two noises.
    let length = (1.5 * libm::pow(ice, 0.25)).clamp(1.5, 7.0);
    let wavelength = [4.0, 2.0].into_iter().find(|wavelength| length >= *wavelength).unwrap_or(1.0);
    let share = libm::log2(length / wavelength);
    let basins = (1.0 - share) * noise(wavelength, BASINS) + share * noise(2.0 * wavelength, BASINS);
    let varied = (1.0 + 0.6 * basins + 0.3 * noise(15.0, REGIONS)).max(0.1);
    let depth = glaciation.depth * libm::pow(ice, DEPTH_EXPONENT);
    (depth * MAX_DEPTH / (depth + MAX_DEPTH) * varied) as f32
}

/// How much the sides of a valley confine its glacier, 0 to 1: where the ground is level, ice spreads and erodes
/// little.
fn confinement(heights: &Grid, q: usize, half: f32) -> f32 {
    let (width, cell) = (heights.width(), heights.window().cell as f32);
    let (column, row) = ((q % width) as isize, (q / width) as isize);
    let around = STEPS.map(|(east, south)| {
        let length = if east * south == 0 { cell } else { std::f32::consts::SQRT_2 * cell };
        let steps = (half.min(AROUND) / length).round().clamp(1.0, MAX_STEPS) as isize;
        let [i, j] = [column + steps * east, row + steps * south];
        let (i, j) = (i.clamp(0, width as isize - 1), j.clamp(0, heights.height() as isize - 1));
        heights.data()[j as usize * width + i as usize]
    });
    let rise = (around.iter().sum::<f32>() * 0.125 - heights.data()[q]).max(0.0);
    rise / (rise + CONFINING)
}

/// The streams of the noise of depths.
const BASINS: u64 = 60;
const REGIONS: u64 = 61;

/// The depth in hashes of glaciers. No level has this depth.
pub const DEPTH: usize = 78;
