//! Lakes with an outlet: on some levels parts of rivers become standing water, whose surface is as high as its outlet. Water in such a lake has receivers
//! that lead to the outlet, so that the river runs on below it, and finer levels keep the lake.

use super::carve::Carved;
use super::children::Children;
use super::drainage::{FREE, WATER};
use super::gradient_noise::{noise, smooth_step};
use super::hash;
use super::level::{LAKE, Level};
use super::refinement::Refinement;
use super::stencil::Extent;
use crate::hydrology::direction::{NONE, STEPS};
use std::f32::consts::SQRT_2;

/// The cells in km of the levels whose rivers become lakes.
const CELLS: std::ops::RangeInclusive<f64> = 0.4..=5.0;

/// Drainage areas of these rivers, in cells.
const AREAS: std::ops::Range<f32> = 16.0..3000.0;

/// Share of their nodes that hold back a lake, where lakes are most frequent.
const MAX_CHANCE: f64 = 0.16;

/// Wavelength, in km, and values of the noise between which lakes are absent and frequent.
const DISTRICTS: f64 = 160.0;
const SPARSE: f64 = -0.35;
const FREQUENT: f64 = 0.45;

/// Logarithms of uplift over erodibility between which lakes are rare, in plains, and frequent, in hills and mountains.
const PLAINS: f64 = -2.5;
const HILLS: f64 = -0.5;
const CHANCE_IN_PLAINS: f64 = 0.1;

/// Links from the outlet to the upper end of a lake, at most.
const MAX_LINKS: usize = 3;

/// Drainage area of a river in the lake, relative to that of the outlet, at least.
const MAIN_SHARE: f32 = 0.35;

/// Slope of the river before it became a lake, and below its outlet, at most.
const MAX_SLOPE: f64 = 0.03;

/// Fall from a lake to the river below: the smallest in metres, if the river fell by as much, and as a share of the river's fall. What is left of the fall is
/// above the lake. Water reaches the end of the link on finer levels, so the fall becomes a step.
const OUTLET_FALL: (f32, f32) = (1.0, 0.1);

/// Half of the width of a new lake around its river, at least and at most, in cells.
const HALF_WIDTH: [f32; 2] = [0.3, 0.75];

/// The largest distance to the shore that land beside lakes has, in cells.
const BESIDE: f32 = 0.5;

/// Irregularity of the shores of lakes, relative to that of coasts.
pub const SHORE_IRREGULARITY: f32 = 0.55;

/// Cells from a node of a lake to those whose distances to the shore it changes, and to the rivers that keep it away.
const WIDEST: usize = 2;

/// A lake is nearer to its own river than to a lower one by this factor of the distances, so that there is a ridge between them.
const NEARER: f32 = 0.6;

/// Cells that the lakes of a cell depend on: to a node of a lake, along the lake to its outlet, and down to the next one.
pub const REACH: usize = WIDEST + 2 * MAX_LINKS + 1;

/// Cells around a lake whose land is not much lower than the lake, so that it does not stand behind a wall.
pub const RIM: usize = 3;

/// Slope of this land away from the lake, and its height over the lake at the shore, in metres.
const RIM_SLOPE: f32 = 0.2;
const RIM_HEIGHT: f32 = 0.1;

/// No smallest height.
pub const ANYTHING: f32 = -1e30;

/// Whether the code of a receiver is that of a lake with an outlet.
#[inline(always)]
pub fn is_lake(code: u8) -> bool {
    code >= LAKE
}

/// Whether a node has a receiver: land, and lakes with an outlet.
#[inline(always)]
pub fn drains(code: u8) -> bool {
    code < NONE || is_lake(code)
}

/// Whether rivers of a level become lakes on the level below.
pub fn begin_at(land: &Refinement, depth: usize) -> bool {
    land.lakes > 0.0 && depth < land.levels && CELLS.contains(&land.kilometres(depth))
}

/// The largest distance to the shore that land beside a lake has, in km, so that lakes can be wider than their rivers.
pub fn beside(land: &Refinement, depth: usize) -> f32 {
    BESIDE * land.kilometres(depth) as f32
}

/// A node of a new lake.
pub struct Part {
    node: usize,
    /// Half of the width of the lake around the river, in cells.
    half_width: f32,
}

/// Turns nodes of rivers into lakes. Nodes [`REACH`] away from the edge are exact.
pub fn begin(land: &Refinement, level: &mut Level) -> Vec<Part> {
    let found = Outlets::new(land, level);
    let steepest = (MAX_SLOPE * land.cell_of(level.depth)) as f32;
    let outlets: Vec<usize> = found.candidates.iter().copied().filter(|&q| found.is_last(level, q)).collect();
    let mut parts = Vec::new();
    for outlet in outlets {
        let Some(below) = downstream(level, outlet) else { continue };
        let (top, least_area) = (level.height[outlet], MAIN_SHARE * level.area[outlet]);
        let fall = top - level.height[below];
        let further = downstream(level, below).map_or(0.0, |next| level.height[below] - level.height[next]);
        if fall.max(further) > steepest {
            continue;
        }
        let surface = level.height[below] + fall.min(OUTLET_FALL.0.max(OUTLET_FALL.1 * fall));
        let bits = found.bits(land, level, outlet);
        let links = (hash::unit(bits << 24) * (MAX_LINKS + 1) as f32) as usize;
        let half_width = HALF_WIDTH[0] + (HALF_WIDTH[1] - HALF_WIDTH[0]) * hash::unit16(bits, 0);
        let (mut lake, mut from) = (vec![outlet], 0);
        for link in 1..=links {
            let until = lake.len();
            let highest = top + link as f32 * steepest;
            for at in from..until {
                let near = donors(level, lake[at]);
                lake.extend(near.filter(|&q| level.area[q] >= least_area && level.height[q] <= highest));
            }
            from = until;
        }
        for node in lake {
            level.height[node] = surface;
            level.receiver[node] += LAKE;
            parts.push(Part { node, half_width });
        }
    }
    parts
}

/// Places the shores of new lakes: at a distance from the links between their nodes.
pub fn shape(parts: &[Part], level: &Level, children: &mut Children) {
    if parts.is_empty() {
        return;
    }
    let (kilometres, width) = (level.window.cell as f32 * 1e-3, level.window.width);
    let mut lowered = vec![0.0f32; children.shore.len()];
    for part in parts {
        let (i, j) = (part.node % width, part.node / width);
        let from = [level.east[part.node], level.south[part.node]];
        let to = link(level, part.node).unwrap_or(from);
        let lower = lower_rivers(level, part.node);
        let rows = 2 * j.saturating_sub(WIDEST)..(2 * (j + WIDEST + 1)).min(children.extent.height);
        for y in rows {
            for x in 2 * i.saturating_sub(WIDEST)..(2 * (i + WIDEST + 1)).min(children.extent.width) {
                let q = y * children.extent.width + x;
                let share = |plane: &[f32]| if children.is_irregular() { plane[q] } else { 0.5 };
                let at = [
                    0.5 * (x as f32 - 2.0 * i as f32 + share(&children.east)),
                    0.5 * (y as f32 - 2.0 * j as f32 + share(&children.south)),
                ];
                let own = distance(at, from, to);
                let other = lower.iter().map(|[from, to]| distance(at, *from, *to)).fold(f32::INFINITY, f32::min);
                let over = own - part.half_width.min(NEARER * other);
                lowered[q] = lowered[q].min(over - BESIDE);
            }
        }
    }
    for (shore, lowered) in children.shore.iter_mut().zip(lowered) {
        *shore += lowered * kilometres;
    }
}

/// The position of the receiver of a lake's node in the same lake, from the corner of the node's cell, in cells.
fn link(level: &Level, q: usize) -> Option<[f32; 2]> {
    let step = STEPS[usize::from(level.receiver[q] & 7)];
    let to = neighbour(level, q, step)?;
    let is_same = is_lake(level.receiver[to]) && level.height[to] == level.height[q];
    is_same.then(|| [level.east[to] + step.0 as f32, level.south[to] + step.1 as f32])
}

/// The links of rivers near a lake's node that are lower than the lake: positions from the corner of the node's cell, in cells.
fn lower_rivers(level: &Level, q: usize) -> Vec<[[f32; 2]; 2]> {
    let reach = WIDEST as isize;
    let around = (-reach..=reach).flat_map(|south| (-reach..=reach).map(move |east| (east, south)));
    let mut found = Vec::new();
    for (east, south) in around {
        let Some(near) = neighbour(level, q, (east, south)) else { continue };
        let is_lower = level.receiver[near] < NONE && level.height[near] < level.height[q];
        let Some(to) = downstream(level, near).filter(|_| is_lower && level.area[near] > 1.5) else { continue };
        let step = STEPS[usize::from(level.receiver[near])];
        let place =
            |node: usize, east: isize, south: isize| [level.east[node] + east as f32, level.south[node] + south as f32];
        found.push([place(near, east, south), place(to, east + step.0, south + step.1)]);
    }
    found
}

/// The smallest heights of land around lakes with an outlet, [`RIM`] cells away from the edge; elsewhere [`ANYTHING`]. Nothing if there is no lake.
pub fn rims(land: &Refinement, depth: usize, extent: Extent, carved: &Carved) -> Vec<f32> {
    let is_lake = |q: usize| carved.fixed[q] == WATER && carved.receiver[q] < WATER;
    if land.lakes == 0.0 || !(0..extent.len()).any(is_lake) {
        return Vec::new();
    }
    let fall = RIM_SLOPE * land.cell_of(depth) as f32;
    let mut least: Vec<f32> =
        (0..extent.len()).map(|q| if is_lake(q) { carved.height[q] + RIM_HEIGHT + fall } else { ANYTHING }).collect();
    let mut next = least.clone();
    let mut inner = extent;
    for _ in 0..RIM {
        inner = inner.shrunk(1);
        for j in inner.rows() {
            let around = inner.around(&least, j);
            for (k, out) in inner.row_mut(&mut next, j).iter_mut().enumerate() {
                for (code, there) in around.iter().enumerate() {
                    let distance = if code & 1 == 1 { SQRT_2 } else { 1.0 };
                    *out = out.max(there[k] - fall * distance);
                }
            }
        }
        least.copy_from_slice(&next);
    }
    // Rivers and water keep their heights.
    for (least, fixed) in least.iter_mut().zip(&carved.fixed) {
        *least = if *fixed == FREE { *least } else { ANYTHING };
    }
    least
}

/// The distance of a point from a line between two others.
fn distance(at: [f32; 2], from: [f32; 2], to: [f32; 2]) -> f32 {
    let (along, away) = ([to[0] - from[0], to[1] - from[1]], [at[0] - from[0], at[1] - from[1]]);
    let square = along[0] * along[0] + along[1] * along[1];
    let share = (along[0] * away[0] + along[1] * away[1]) / square.max(1e-6);
    let share = share.clamp(0.0, 1.0);
    let (x, y) = (away[0] - share * along[0], away[1] - share * along[1]);
    (x * x + y * y).sqrt()
}

/// Nodes of rivers that may become the outlets of lakes.
struct Outlets {
    candidates: Vec<usize>,
    is_candidate: Vec<bool>,
}

impl Outlets {
    fn new(land: &Refinement, level: &Level) -> Outlets {
        let mut outlets = Outlets { candidates: Vec::new(), is_candidate: vec![false; level.window.len()] };
        for q in 0..level.window.len() {
            if level.receiver[q] < NONE && AREAS.contains(&level.area[q]) {
                let draw = f64::from(hash::unit(outlets.bits(land, level, q)));
                let most = land.lakes * MAX_CHANCE;
                if draw < most && draw < most * frequency(land, level, q) {
                    outlets.candidates.push(q);
                    outlets.is_candidate[q] = true;
                }
            }
        }
        outlets
    }

    fn bits(&self, land: &Refinement, level: &Level, q: usize) -> u64 {
        let (x, y) = place(level, q);
        hash::node(land.seed, level.depth, x, y, 13)
    }

    /// Whether no other candidate is so near downstream that its lake may reach this one, and the river runs on over land.
    fn is_last(&self, level: &Level, q: usize) -> bool {
        let mut at = q;
        for link in 0..=MAX_LINKS {
            at = match downstream(level, at) {
                Some(next) if level.receiver[next] < NONE => next,
                _ => return link > 0,
            };
            if self.is_candidate[at] {
                return false;
            }
        }
        true
    }
}

/// How frequent lakes are around a node, 0 to 1.
fn frequency(land: &Refinement, level: &Level, q: usize) -> f64 {
    let (x, y) = place(level, q);
    let kilometres = |index: i64, share: f32| land.metres(level.depth, index, share) * 1e-3;
    let (east, south) = (kilometres(x, level.east[q]), kilometres(y, level.south[q]));
    let district = smooth_step(SPARSE, FREQUENT, noise(land.seed, 8, east / DISTRICTS, south / DISTRICTS));
    let relief = smooth_step(PLAINS, HILLS, f64::from(level.uplift[q]));
    district * (CHANCE_IN_PLAINS + (1.0 - CHANCE_IN_PLAINS) * relief)
}

/// Column and row of the cell of a node.
fn place(level: &Level, q: usize) -> (i64, i64) {
    (level.window.x + (q % level.window.width) as i64, level.window.y + (q / level.window.width) as i64)
}

/// The neighbour in a direction, if it is within the window.
fn neighbour(level: &Level, q: usize, (east, south): (isize, isize)) -> Option<usize> {
    let (width, height) = (level.window.width, level.window.height);
    let (i, j) = ((q % width).checked_add_signed(east)?, (q / width).checked_add_signed(south)?);
    (i < width && j < height).then_some(j * width + i)
}

/// The receiver of a node on land.
fn downstream(level: &Level, q: usize) -> Option<usize> {
    neighbour(level, q, *STEPS.get(usize::from(level.receiver[q]))?)
}

/// The nodes on land whose receiver is a node.
fn donors(level: &Level, q: usize) -> impl Iterator<Item = usize> {
    STEPS.iter().enumerate().filter_map(move |(code, step)| {
        let donor = neighbour(level, q, *step)?;
        (usize::from(level.receiver[donor]) == (code + 4) & 7).then_some(donor)
    })
}
