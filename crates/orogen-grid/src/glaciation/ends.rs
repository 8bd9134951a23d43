//! The ends of glaciers: end moraines, and outwash before them.

use super::beds::{Beds, DEPTH, NOWHERE};
use super::{Glaciated, Glaciation};
use crate::grid::Grid;
use crate::hydrology::direction::strides;
use crate::multiscale::gradient_noise::noise;
use crate::multiscale::hash;

/// How far upstream of its end the ice of a glacier decides on its deposits, in metres.
const UPSTREAM: f64 = 1200.0;
/// Ice in km^2 from which on a glacier leaves deposits, and from which on they are as large as they get.
const SIZES: [f32; 2] = [1.0, 30.0];
/// Slopes of the valley up to which deposits stay, and from which on rivers carry all of them away.
const SLOPES: [f32; 2] = [0.06, 0.14];
/// The greatest radius of a moraine, in metres.
const MAX_RADIUS: f32 = 700.0;
/// Distance of the moraines of one glacier from its end, in radii, and their heights as shares of the largest.
const STAGES: [(f32, f32); 3] = [(0.0, 1.0), (1.2, 0.6), (2.1, 0.4)];
/// Half of the width of a moraine, in heights.
const FLANK: f32 = 4.0;
/// Share of the moraines that the river has cut through. The others hold a lake.
const CUT: f32 = 0.7;
/// Greatest reach of a deposit from its line, in samples.
const MAX_REACH: f64 = 160.0;
/// How far outwash reaches down the valley, in metres.
const OUTWASH: f64 = 2400.0;
/// Thickness of outwash at the end of the glacier, as a share of the height of the moraine.
const THICKNESS: f32 = 0.7;

pub fn links(length: f64, cell: f64) -> usize {
    ((length / cell) as usize).clamp(1, 64)
}

/// Number of samples around a sample on which its deposits depend.
pub fn reach(cell: f64) -> usize {
    // A moraine is at most two radii from its stage, which is at most 64 samples from the end.
    let stages = links(f64::from(2.1 * MAX_RADIUS), cell) + links(UPSTREAM, cell);
    2 + stages.max(links(OUTWASH, cell)) + around(2.0 * MAX_RADIUS, cell)
}

/// A distance in samples; at very small cells deposits are cut off.
fn around(distance: f32, cell: f64) -> usize {
    (f64::from(distance) / cell).ceil().min(MAX_REACH) as usize
}

/// A place where a glacier has ended.
struct End {
    /// The last node.
    node: usize,
    /// Nodes upstream of it, from the end.
    line: Vec<usize>,
    /// Radius of the moraine in metres, and its height.
    radius: f32,
    height: f32,
    bits: u64,
}

/// Lays moraines and outwash on the ground.
pub fn lay(glaciation: &Glaciation, land: &Glaciated, beds: &Beds, ground: &mut Grid) {
    let bare = ground.clone();
    for node in 0..beds.len() {
        if let Some(end) = End::at(node, glaciation, land, beds) {
            end.lay_outwash(land, beds, ground);
            for (stage, share) in STAGES {
                end.lay_moraine(glaciation, beds, &bare, ground, stage, share);
            }
        }
    }
}

impl End {
    /// The end of a glacier at a node, if it is one and leaves deposits.
    fn at(node: usize, glaciation: &Glaciation, land: &Glaciated, beds: &Beds) -> Option<End> {
        if beds.receiver[node] != NOWHERE || glaciation.moraines <= 0.0 {
            return None;
        }
        let window = land.height.window();
        let mut line = vec![node];
        for _ in 0..links(UPSTREAM, window.cell) {
            let up = beds.donor[line[line.len() - 1]];
            if up == NOWHERE {
                return None;
            }
            line.push(up as usize);
        }
        let ice = beds.ice[line[line.len() - 1]];
        let fall = land.height.data()[beds.sample[line[line.len() - 1]]] - land.height.data()[beds.sample[node]];
        let slope = fall / (links(UPSTREAM, window.cell) as f32 * window.cell as f32);
        let gentle = ((SLOPES[1] - slope) / (SLOPES[1] - SLOPES[0])).clamp(0.0, 1.0);
        let size = gentle * ((ice - SIZES[0]) / (SIZES[1] - SIZES[0])).clamp(0.0, 1.0).sqrt();
        let radius = glaciation.half_width(ice).min(MAX_RADIUS);
        let q = beds.sample[node];
        let (x, y) = (window.x + (q % window.width) as i64, window.y + (q / window.width) as i64);
        let bits = hash::node(glaciation.seed, DEPTH, x, y, 3);
        let height = size * glaciation.moraines as f32;
        (height > 0.0).then_some(End { node, line, radius, height, bits })
    }

    /// Raises the ground to an arc across the valley, `stage` radii upstream of the end.
    fn lay_moraine(
        &self,
        glaciation: &Glaciation,
        beds: &Beds,
        bare: &Grid,
        ground: &mut Grid,
        stage: f32,
        share: f32,
    ) {
        let window = *bare.window();
        let (width, cell) = (window.width, window.cell as f32);
        let at = ((stage * self.radius / cell) as usize).min(self.line.len() - 1);
        let place = |node: usize| [(beds.sample[node] % width) as f32, (beds.sample[node] / width) as f32];
        let (tip, tail) = (place(self.line[at]), place(self.line[self.line.len() - 1]));
        let end = place(self.node);
        let along = [end[0] - tail[0], end[1] - tail[1]];
        let length = (along[0] * along[0] + along[1] * along[1]).sqrt();
        let height = share * self.height;
        if length < 1.0 || height < 1.0 {
            return;
        }
        let along = along.map(|part| part / length);
        let flank = (FLANK * height).max(0.8 * cell);
        let floor = bare.data()[beds.sample[self.line[at]]];
        let is_cut = hash::unit(self.bits.rotate_left(13 * at as u32)) < CUT;
        let reach = around(2.0 * self.radius, window.cell);
        let (column, row) = (tip[0] as usize, tip[1] as usize);
        for j in row.saturating_sub(reach)..(row + reach + 1).min(window.height) {
            for i in column.saturating_sub(reach)..(column + reach + 1).min(width) {
                let [east, south] = [(i as f32 - tip[0]) * cell, (j as f32 - tip[1]) * cell];
                let (ahead, aside) = (east * along[0] + south * along[1], south * along[0] - east * along[1]);
                // The distance to the arc, which bends upstream.
                let bend = aside / (0.6 * self.radius);
                let distance = (ahead + 0.3 * self.radius * bend * bend).abs() / (1.0 + bend * bend).sqrt();
                let away = aside.abs() / self.radius;
                if distance > 2.0 * flank || away > 1.3 {
                    continue;
                }
                let metres = [window.east(i) * 1e-3 / 0.5, window.south(j) * 1e-3 / 0.5];
                let uneven = 0.8 + 0.5 * noise(glaciation.seed, 62, metres[0], metres[1]) as f32;
                let slope = 1.0 - distance / (2.0 * flank);
                let gap = if is_cut { ((aside / cell).abs() / 1.5).min(1.0) } else { 1.0 };
                let crest = floor + height * uneven * slope * slope * (3.0 - 2.0 * slope) * gap * (1.3 - away).min(1.0);
                let there = &mut ground.data_mut()[j * width + i];
                *there = there.max(crest);
            }
        }
    }

    /// Raises the floor of the valley before the glacier.
    fn lay_outwash(&self, land: &Glaciated, beds: &Beds, ground: &mut Grid) {
        let window = *ground.window();
        let (width, cell) = (window.width, window.cell as f32);
        let (steps, count) = (strides(width), links(OUTWASH, window.cell));
        let mut q = beds.sample[self.node];
        for link in 0..count {
            let (column, row) = (q % width, q / width);
            let code = land.receiver.data()[q];
            if !(0.0..8.0).contains(&code) || column == 0 || row == 0 || column + 1 == width || row + 1 == window.height
            {
                return;
            }
            let left = 1.0 - link as f32 / count as f32;
            let (fill, river) = (THICKNESS * self.height * left * left, land.height.data()[q]);
            let reach = around(self.radius, window.cell);
            for j in row.saturating_sub(reach)..(row + reach + 1).min(window.height) {
                for i in column.saturating_sub(reach)..(column + reach + 1).min(width) {
                    let [east, south] = [i.abs_diff(column) as f32, j.abs_diff(row) as f32].map(|side| side * cell);
                    let away = (east * east + south * south) / (self.radius * self.radius);
                    if away < 1.0 {
                        let there = &mut ground.data_mut()[j * width + i];
                        *there = there.max(river + fill * (1.0 - away));
                    }
                }
            }
            q = q.wrapping_add_signed(steps[code as usize & 7]);
        }
    }
}
