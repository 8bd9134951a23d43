//! Drawn ridges on a level: nothing drains to them, and the land beside them rises to their heights.
//!
//! While a level grows, the nodes of ridges are hidden, so that ridges become divides. Then the heights beside them
//! change: along the path of a node to the next river of the coarser level, the share of the way that is behind it
//! becomes the share of the rise to the ridge. Receivers stay, and nodes stay above them. The uplift changes, too, so
//! that finer levels grow to about the same heights.
//!
//! Related: heights of drawn curves that spread level by level (Hnaidi and others 2010).

use super::carve::{Carved, UNKNOWN};
use super::children::Children;
use super::drainage::{FREE, WATER};
use super::drawn_ridges::{BESIDE, Crest, DrawnRidges, Near, RIDGE};
use super::law::slope_of_one_cell;
use super::level::Level;
use super::refinement::Refinement;
use super::surface::Surface;
use crate::grid::Window;
use crate::hydrology::direction::{NONE, STEPS};
use std::f32::consts::FRAC_1_SQRT_2;

/// Distance from a ridge, in cells, within which the heights of a level change.
pub const REACH: f64 = 6.5;

/// Distance from a ridge within which the land is raised to it, relative to the height of the ridge.
const WIDTH: f32 = 10.0;

/// Maximum number of links from a node to a river of the coarser level.
pub const LINKS: usize = 8;

/// Number of passes in which land that only ridges surround drains to them.
pub const POCKET_PASSES: usize = 3;

/// Number of cells on which the heights beside ridges depend.
pub const EDGE: usize = edge(LINKS) + POCKET_PASSES;

/// Number of cells on which heights depend with this number of links: a height on those of the receivers, these on
/// ridges that drain through them, and these on their own ways.
pub const fn edge(links: usize) -> usize {
    3 * links + 1
}

/// Maximum change of the logarithm of uplift over erodibility on a level, and the range of the result.
const MAX_CHANGE: f32 = 1.5;
const LOGARITHMS: [f32; 2] = [-4.0, 2.5];

/// Change of the logarithm of a slope with that of uplift over erodibility, about.
const SENSITIVITY: f32 = 0.6;

/// Slope from which on hillsides are straight.
const STRAIGHT: f32 = 0.6;

/// Share of the growth on finer levels that a ridge is left to rise.
const LATER: f32 = 0.6;

/// Slope beside a ridge, and the greatest share of its height by which a node is lower that is not on it, on the level
/// whose nodes are on the lattice.
const CREST_SLOPE: f32 = 0.5;
const CREST_DROP: f32 = 0.008;

/// Marks the cells of ridges and the eight cells around each; empty if there are none.
pub fn marks(crests: &[Crest], width: usize, cells: usize) -> Vec<u8> {
    if crests.is_empty() {
        return Vec::new();
    }
    let mut marks = vec![0; cells];
    for crest in crests {
        for (east, south) in STEPS {
            if let Some(q) = beside(crest.q, (east, south), width, cells) {
                marks[q] = marks[q].max(BESIDE);
            }
        }
        marks[crest.q] = RIDGE;
    }
    marks
}

/// The cell next to `q`, if it is in the plane.
fn beside(q: usize, (east, south): (isize, isize), width: usize, cells: usize) -> Option<usize> {
    let i = (q % width).checked_add_signed(east).filter(|i| *i < width)?;
    let j = (q / width).checked_add_signed(south)?;
    Some(j * width + i).filter(|q| *q < cells)
}

/// Ridges of a level that grows.
pub struct Ridges {
    crests: Vec<Crest>,
    /// Heights of the crests by the law.
    natural: Vec<f32>,
    near: Vec<Near>,
    /// Whether the level above gives a node its height.
    known: Vec<bool>,
    /// What is added to the logarithm of uplift over erodibility.
    pub added: Vec<f32>,
}

impl Ridges {
    /// The ridges where no river and no water is. `None` if there are none.
    pub fn new(
        land: &Refinement,
        children: &Children,
        drawing: Option<&DrawnRidges>,
        crests: &[Crest],
        carved: &Carved,
    ) -> Option<Ridges> {
        if crests.is_empty() {
            return None;
        }
        let place = |q: usize| if children.is_irregular() { [children.east[q], children.south[q]] } else { [0.5; 2] };
        let near = drawing?.near(land, children.depth, &children.window, REACH, place);
        let is_free = |crest: &&Crest| carved.fixed[crest.q] == FREE && carved.height[crest.q] == UNKNOWN;
        let mut crests: Vec<Crest> = crests.iter().filter(is_free).copied().collect();
        if !children.is_irregular() {
            for crest in &mut crests {
                let least = (1.0 - CREST_DROP) * crest.height;
                crest.height = (crest.height - CREST_SLOPE * near[crest.q].distance).max(least);
            }
        }
        let known = carved.height.iter().map(|height| *height < UNKNOWN).collect();
        Some(Ridges { natural: vec![UNKNOWN; crests.len()], crests, near, known, added: Vec::new() })
    }

    /// Minimum heights with which rivers beside ridges keep theirs.
    pub fn hold(&self, carved: &Carved, least: &mut Vec<f32>, anything: f32) {
        for (q, near) in self.near.iter().enumerate() {
            if near.distance < f32::INFINITY && self.known[q] && carved.fixed[q] != WATER {
                least.resize(self.near.len(), anything);
                least[q] = carved.height[q].max(least[q]);
            }
        }
    }

    /// Hides the nodes of ridges after a pass, so that nothing drains to them.
    pub fn hide(&mut self, height: &mut [f32]) {
        for (crest, natural) in self.crests.iter().zip(&mut self.natural) {
            *natural = std::mem::replace(&mut height[crest.q], UNKNOWN);
        }
    }

    /// Shows the nodes of ridges, at the heights of the last pass.
    pub fn show(&self, height: &mut [f32]) {
        self.crests.iter().zip(&self.natural).for_each(|(crest, natural)| height[crest.q] = *natural);
    }

    /// Directs the hidden nodes of ridges along the steepest descent.
    pub fn descend(&self, height: &[f32], receiver: &mut [f32], width: usize) {
        for (crest, own) in self.crests.iter().zip(&self.natural) {
            let mut steepest = 0.0;
            for (code, step) in STEPS.into_iter().enumerate() {
                let Some(to) = beside(crest.q, step, width, height.len()) else { continue };
                let fall = (own - height[to]) * if code & 1 == 1 { FRAC_1_SQRT_2 } else { 1.0 };
                if fall > steepest {
                    (steepest, receiver[crest.q]) = (fall, code as f32);
                }
            }
        }
    }

    /// The heights of ridges replace those after a pass.
    pub fn keep(&self, from: &[f32], height: &mut [f32]) {
        self.crests.iter().for_each(|crest| height[crest.q] = from[crest.q]);
    }

    /// Raises, or lowers, the land to the ridges.
    pub fn bind(
        &mut self,
        land: &Refinement,
        children: &Children,
        height: &mut Vec<f32>,
        receiver: &mut [f32],
        fixed: &[f32],
    ) {
        let place = |q: usize| if children.is_irregular() { [children.east[q], children.south[q]] } else { [0.5; 2] };
        let mut flanks = Flanks {
            land,
            depth: children.depth,
            width: children.extent.width,
            receiver,
            near: &self.near,
            links: LINKS,
            place: &place,
            is_known: &|q| self.known[q],
            logarithm: &|q| children.variation[q] + children.uplift[q],
        };
        flanks.turn_to_lowest(height, &self.crests);
        let (bound, added) = flanks.bind(height, &self.crests);
        *height = flanks.above_receivers(bound, &|q| fixed[q] == FREE);
        self.added = added;
    }
}

/// The land beside ridges.
pub struct Flanks<'a> {
    pub land: &'a Refinement,
    pub depth: usize,
    pub width: usize,
    pub receiver: &'a mut [f32],
    pub near: &'a [Near],
    /// Maximum number of links to a node with a known height.
    pub links: usize,
    pub place: &'a dyn Fn(usize) -> [f32; 2],
    pub is_known: &'a dyn Fn(usize) -> bool,
    /// Logarithm of uplift over erodibility.
    pub logarithm: &'a dyn Fn(usize) -> f32,
}

impl Flanks<'_> {
    /// Directs ridges that are not above the river that they drain to, to the lowest river of those beside them.
    pub fn turn_to_lowest(&mut self, height: &[f32], crests: &[Crest]) {
        let is_crest = |q: usize| crests.binary_search_by_key(&q, |crest| crest.q).is_ok();
        for crest in crests {
            let mut lowest = height[self.root(crest.q)];
            if lowest < 0.99 * crest.height {
                continue;
            }
            let mut best = None;
            for code in [0usize, 2, 4, 6] {
                let to = beside(crest.q, STEPS[code], self.width, height.len()).filter(|to| !is_crest(*to));
                let to = to.filter(|to| self.way(*to).all(|passed| passed != crest.q));
                let low = to.map(|to| height[if (self.is_known)(to) { to } else { self.root(to) }]);
                if let Some(low) = low.filter(|low| *low < lowest) {
                    (lowest, best) = (low, Some(code as f32));
                }
            }
            if let Some(code) = best {
                self.receiver[crest.q] = code;
            }
        }
    }

    /// The heights with those of ridges and of the land beside them, and what is added to the logarithm of uplift over
    /// erodibility. Nodes may be below their receivers.
    pub fn bind(&self, height: &[f32], crests: &[Crest]) -> (Vec<f32>, Vec<f32>) {
        let mut bound = height.to_vec();
        let mut added = vec![0.0; if self.land.is_detail(self.depth) { 0 } else { height.len() }];
        let cell = self.land.cell_of(self.depth) as f32;
        for (q, near) in self.near.iter().enumerate() {
            if near.distance == f32::INFINITY || (self.is_known)(q) || self.receiver[q] >= WATER {
                continue;
            }
            let (low, top) = (height[self.root(q)], near.height);
            if top <= low || height[q] <= low || height[q] >= UNKNOWN {
                continue;
            }
            let logarithm = (self.logarithm)(q);
            let later = 1.0 + LATER * (later_growth(self.land, self.depth, logarithm) - 1.0);
            let (behind, ahead, rise) = self.shares(height, q, near.distance * later, top - low);
            let wide = WIDTH * top.max(height[q]);
            let share = near.distance / (REACH as f32 * cell);
            let to_ridge = low + (top - low) * behind / (behind + ahead);
            let is_higher = height[q] > to_ridge;
            let weight = fall((2.0 * share - 1.0).max(0.0)) * if is_higher { 1.0 } else { fall(near.distance / wide) };
            bound[q] = height[q] + weight * (to_ridge - height[q]);
            if let Some(added) = added.get_mut(q) {
                let ratio = (top - low) / rise;
                let change = libm::log(f64::from(ratio.clamp(1e-3, 1e3))) as f32 / SENSITIVITY;
                let change = change.clamp(-MAX_CHANGE, MAX_CHANGE) * weight * fall(cell / wide);
                let [least, most] = LOGARITHMS;
                *added = (logarithm + change).clamp(least.min(logarithm), most.max(logarithm)) - logarithm;
            }
        }
        for crest in crests {
            // The whole way from a low ridge is below it.
            let (natural, low) = (height[crest.q], height[self.root(crest.q)]);
            let share = (crest.height - low) / (natural - low);
            if (0.0..1.0).contains(&share) && natural < UNKNOWN {
                for q in self.way(crest.q).filter(|q| !(self.is_known)(*q)) {
                    bound[q] = bound[q].min(low + share * (height[q] - low));
                }
            }
        }
        for crest in crests {
            bound[crest.q] = crest.height;
        }
        (bound, added)
    }

    /// The parts of the way from a node to the river and from there on to the ridge: lengths on steep land, where
    /// hillsides are straight, and rises on gentle land. The third number is the rise from the river to the ridge by
    /// the law.
    fn shares(&self, height: &[f32], q: usize, distance: f32, rise: f32) -> (f32, f32, f32) {
        let cell = self.land.cell_of(self.depth) as f32;
        let (mut at, mut length, mut first) = (q, 0.0, 0.0);
        for next in self.way(q) {
            let metres = self.metres(at, next).max(0.1 * cell);
            if at == q {
                first = (height[q] - height[next]).max(0.0) / metres;
            }
            (at, length) = (next, length + metres);
        }
        let behind = (height[q] - height[at]).max(0.0);
        let by_law = behind + distance * first;
        let gentle = ((STRAIGHT - rise / (length + distance)) / STRAIGHT).clamp(0.0, 1.0);
        let gentle = if self.land.is_detail(self.depth) { 0.0 } else { gentle };
        let mean = by_law / (length + distance);
        let part = |rise: f32, length: f32| gentle * rise + (1.0 - gentle) * mean * length;
        (part(behind, length), part(distance * first, distance), by_law)
    }

    /// The node with a known height to which a node drains, as far as it is followed.
    fn root(&self, q: usize) -> usize {
        self.way(q).last().unwrap_or(q)
    }

    /// The nodes after `q` down to one with a known height.
    fn way(&self, q: usize) -> impl Iterator<Item = usize> + '_ {
        let next = move |at: &usize| self.next(*at).filter(|_| *at == q || !(self.is_known)(*at));
        std::iter::successors(Some(q), next).skip(1).take(self.links)
    }

    /// The heights with every free node above its receiver.
    pub fn above_receivers(&self, mut height: Vec<f32>, is_free: &dyn Fn(usize) -> bool) -> Vec<f32> {
        let rise = self.land.least_rise(self.depth);
        for _ in 0..self.links {
            let mut raised = Vec::new();
            for q in 0..height.len() {
                let Some(to) = self.next(q).filter(|_| is_free(q)) else { continue };
                if height[q] < height[to] + rise && height[to] < UNKNOWN {
                    raised.push((q, height[to] + rise));
                }
            }
            if raised.is_empty() {
                break;
            }
            raised.into_iter().for_each(|(q, raised)| height[q] = raised);
        }
        height
    }

    /// The receiver of a node.
    fn next(&self, q: usize) -> Option<usize> {
        let code = self.receiver[q];
        let step = *STEPS.get(if (0.0..WATER).contains(&code) { code as usize } else { usize::MAX })?;
        beside(q, step, self.width, self.receiver.len())
    }

    fn metres(&self, from: usize, to: usize) -> f32 {
        let [a, b] = [from, to].map(self.place);
        let columns = (to % self.width) as isize - (from % self.width) as isize;
        let rows = (to / self.width) as isize - (from / self.width) as isize;
        let (x, y) = (columns as f32 + (b[0] - a[0]), rows as f32 + (b[1] - a[1]));
        (x * x + y * y).sqrt() * self.land.cell_of(self.depth) as f32
    }
}

/// A weight that falls from 1 to 0 as `share` grows from 0 to 1.
fn fall(share: f32) -> f32 {
    let rest = (1.0 - share * share).max(0.0);
    if share < 1.0 { rest * rest } else { 0.0 }
}

/// The rise over a cell of a level after all finer levels have grown, relative to that on the level.
fn later_growth(land: &Refinement, depth: usize, logarithm: f32) -> f32 {
    let slope = |depth: usize| slope_of_one_cell(land, depth, logarithm) / land.cell_of(depth) as f32;
    let (mut rest, mut sum) = (1.0, 0.0);
    for depth in depth..land.levels {
        rest *= 0.5;
        sum += rest * slope(depth);
    }
    (sum + rest * slope(land.levels)) / slope(depth)
}

/// Distances of samples from a ridge, in cells, up to which they have its height, and from which on they have their
/// own.
const ON_RIDGE: f32 = 0.5;
const OFF_RIDGE: f32 = 1.25;

/// Share of its height by which a ridge may be higher than the nodes around it; otherwise a river runs through it.
const GAP: f32 = 0.03;

impl DrawnRidges {
    /// Gives samples of a surface on ridges the heights of the ridges, where heights are interpolated between nodes.
    pub fn raise(&self, land: &Refinement, level: &Level, share: f32, window: &Window, surface: &mut Surface) {
        if land.is_finest(level.depth) {
            return;
        }
        let (nodes, inside) = (land.nodes_at(level.depth, window), land.inside(level.depth, share));
        let cell = land.cell_of(level.depth) as f32;
        let near = self.near(land, level.depth, &nodes, f64::from(OFF_RIDGE), |_| [inside; 2]);
        for (k, near) in near.iter().enumerate().filter(|(_, near)| near.distance < f32::INFINITY) {
            let (i, j) = (k % window.width, k / window.width);
            let q = level.row(&nodes, j) + i;
            let rows = [q - level.window.width, q, q + level.window.width];
            let around = rows.into_iter().flat_map(|row| row - 1..row + 2);
            let highest = around.filter(|o| level.receiver[*o] < NONE).map(|o| level.height[o]).fold(0.0, f32::max);
            if highest >= (1.0 - GAP) * near.height && surface.water_level[(i, j)].is_nan() {
                let off = (near.distance / cell - ON_RIDGE) / (OFF_RIDGE - ON_RIDGE);
                let own = surface.height[(i, j)];
                surface.height[(i, j)] = own + fall(off.max(0.0)) * (near.height - own);
            }
        }
    }
}
