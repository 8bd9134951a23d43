//! Lakes with an outlet: on some levels parts of rivers become standing water. Water in such a lake has receivers
//! that lead to the outlet, so that the river runs on below it, and finer levels keep the lake.

use super::gradient_noise::{noise, smooth_step};
use super::hash;
use super::level::{LAKE, Level};
use super::refinement::Refinement;
use crate::hydrology::direction::{NONE, STEPS};

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

/// Fall from a lake to the river below, in metres, if the river fell by as much, and at least this share of the river's
/// fall. What is left of the fall is above the lake: finer levels have water up to the end of the link, so that its
/// fall becomes a step.
const OUTLET_FALL: f32 = 1.0;
const OUTLET_SHARE: f32 = 0.1;

/// Half of the width of a new lake around its river, at least and at most, in cells.
const HALF_WIDTH: [f32; 2] = [0.3, 0.75];

/// The largest distance to the shore that land beside lakes has, in cells.
pub const BESIDE: f32 = 0.5;

/// Irregularity of the shores of lakes, relative to that of coasts.
pub const SHORE_IRREGULARITY: f32 = 0.55;

/// Cells from a node of a lake to those whose distances to the shore it changes, and to the rivers that keep it away.
pub const WIDEST: usize = 2;

/// Cells that the lakes of a cell depend on: to a node of a lake and on to a lower river or another lake, along that to
/// its outlet, and down to the next one.
pub const REACH: usize = 2 * WIDEST + 2 * MAX_LINKS + 1;

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
    pub node: usize,
    /// Half of the width of the lake around the river, in cells.
    pub half_width: f32,
}

/// Turns nodes of rivers into lakes. Nodes [`REACH`] away from the edge are exact.
pub fn begin(land: &Refinement, level: &mut Level) -> Vec<Part> {
    let found = Outlets::new(land, level);
    let steepest = (MAX_SLOPE * land.cell_of(level.depth)) as f32;
    // No lake depends on what another one does.
    let (heights, receivers) = (level.height.clone(), level.receiver.clone());
    let suits = |q: usize| found.is_last(level, q) && is_dry(level, &receivers, q);
    let outlets: Vec<usize> = found.candidates.iter().copied().filter(|&q| suits(q)).collect();
    let mut parts = Vec::new();
    for outlet in outlets {
        let Some(below) = level.downstream(outlet) else { continue };
        let (top, least_area) = (heights[outlet], MAIN_SHARE * level.area[outlet]);
        let fall = top - heights[below];
        let further = level.downstream(below).map_or(0.0, |next| heights[below] - heights[next]);
        if fall.max(further) > steepest {
            continue;
        }
        let surface = heights[below] + fall.min(OUTLET_FALL.max(OUTLET_SHARE * fall));
        let bits = found.bits(land, level, outlet);
        let links = (hash::unit(bits << 24) * (MAX_LINKS + 1) as f32) as usize;
        let half_width = HALF_WIDTH[0] + (HALF_WIDTH[1] - HALF_WIDTH[0]) * hash::unit16(bits, 0);
        let (mut lake, mut from) = (vec![outlet], 0);
        for link in 1..=links {
            let until = lake.len();
            let highest = top + link as f32 * steepest;
            for at in from..until {
                let near = donors(level, lake[at]).filter(|&q| level.area[q] >= least_area && heights[q] <= highest);
                lake.extend(near.filter(|&q| is_dry(level, &receivers, q)));
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

/// Whether no node around a node is water.
fn is_dry(level: &Level, receivers: &[u8], q: usize) -> bool {
    STEPS.into_iter().all(|step| level.neighbor(q, step).is_none_or(|near| receivers[near] < NONE))
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
        let (x, y) = level.place(q);
        hash::node(land.seed, level.depth, x, y, 13)
    }

    /// Whether neither standing water nor another candidate, whose lake may reach this one, is near downstream.
    fn is_last(&self, level: &Level, q: usize) -> bool {
        let mut at = q;
        (0..=MAX_LINKS).all(|_| match level.downstream(at) {
            Some(next) if level.receiver[next] < NONE && !self.is_candidate[next] => {
                at = next;
                true
            }
            _ => false,
        })
    }
}

/// How frequent lakes are around a node, 0 to 1.
fn frequency(land: &Refinement, level: &Level, q: usize) -> f64 {
    let (x, y) = level.place(q);
    let kilometres = |index: i64, share: f32| land.metres(level.depth, index, share) * 1e-3;
    let (east, south) = (kilometres(x, level.east[q]), kilometres(y, level.south[q]));
    let district = smooth_step(SPARSE, FREQUENT, noise(land.seed, 8, east / DISTRICTS, south / DISTRICTS));
    let relief = smooth_step(PLAINS, HILLS, f64::from(level.uplift[q]));
    district * (CHANCE_IN_PLAINS + (1.0 - CHANCE_IN_PLAINS) * relief)
}

/// The nodes on land whose receiver is a node.
fn donors(level: &Level, q: usize) -> impl Iterator<Item = usize> {
    STEPS.iter().enumerate().filter_map(move |(code, step)| {
        let donor = level.neighbor(q, *step)?;
        (usize::from(level.receiver[donor]) == (code + 4) & 7).then_some(donor)
    })
}
