//! Lakes with an outlet: on some levels, parts of rivers become standing water. The water of such a lake has receivers
//! that lead to the outlet, so that the river continues below it, and finer levels keep the lake.

use super::gradient_noise::{noise, smooth_step};
use super::hash;
use super::level::{LAKE, Level};
use super::passages::Passages;
use super::refinement::Refinement;
use crate::hydrology::direction::{NONE, STEPS};

/// Cell sizes, in km, of the levels on which rivers become lakes.
const CELLS: std::ops::RangeInclusive<f64> = 0.4..=5.0;

/// Drainage areas of rivers that can become lakes, in cells.
const AREAS: std::ops::Range<f32> = 16.0..3000.0;

/// Share of the nodes of these rivers that become outlets of lakes, where lakes are most frequent.
const MAX_CHANCE: f64 = 0.16;

/// Wavelengths, in km, of the noises of the frequency of lakes, the weight of the second one, what high mountains add,
/// and the values of the sum for rare and for frequent lakes. As on Earth, lakes are frequent where ice was: on a fifth
/// of the land, more often in mountains.
const DISTRICTS: [f64; 2] = [1100.0, 160.0];
const FINE_DISTRICTS: f64 = 0.5;
const IN_MOUNTAINS: f64 = 0.3;
const SPARSE: f64 = 0.1;
const FREQUENT: f64 = 0.5;

/// Frequency of lakes where they are rare.
const LEAST: f64 = 0.02;

/// Logarithms of uplift over erodibility for rare lakes, in plains, and for frequent lakes, in hills and mountains.
const PLAINS: f64 = -2.5;
const HILLS: f64 = -0.5;
const MOUNTAINS: f64 = 0.6;
const CHANCE_IN_PLAINS: f64 = 0.1;

/// Maximum number of links from the outlet to the upper end of a lake.
const MAX_LINKS: usize = 3;

/// Minimum drainage area of a river in the lake, relative to that of the outlet.
const MAIN_SHARE: f32 = 0.35;

/// Maximum slope of the river before it becomes a lake, and of the river below its outlet.
const MAX_SLOPE: f64 = 0.03;

/// Fall from a lake to the river below, in metres, if the river fell by as much, and its minimum as a share of the
/// river's fall. The rest of the fall is above the lake: on finer levels the water extends to the end of the link, so
/// that this fall becomes a step.
const OUTLET_FALL: f32 = 1.0;
const OUTLET_SHARE: f32 = 0.1;

/// Minimum and maximum of half the width of a new lake around its river, in cells.
const HALF_WIDTH: [f32; 2] = [0.3, 0.75];

/// Maximum distance to the shore of land next to lakes, in cells.
pub const BESIDE: f32 = 0.5;

/// Irregularity of the shores of lakes, relative to that of coasts.
pub const SHORE_IRREGULARITY: f32 = 0.55;

/// Distance in cells from a node of a lake at which it changes distances to the shore, and at which lower rivers limit
/// the lake.
pub const WIDEST: usize = 2;

/// Number of cells that the lakes of a cell depend on: to a node of a lake and on to a lower river or another lake,
/// along that to its outlet, and down to the next one.
pub const REACH: usize = 2 * WIDEST + 2 * MAX_LINKS + 1;

/// Whether a receiver code is that of a lake with an outlet.
#[inline(always)]
pub fn is_lake(code: u8) -> bool {
    code >= LAKE
}

/// Whether a node with this receiver code has a receiver, which is true for land and lakes with an outlet.
#[inline(always)]
pub fn drains(code: u8) -> bool {
    code < NONE || is_lake(code)
}

/// Whether rivers of a level become lakes on the next finer level.
pub fn begin_at(land: &Refinement, depth: usize) -> bool {
    land.lakes > 0.0 && depth < land.levels && CELLS.contains(&land.kilometres(depth))
}

/// Maximum distance to the shore of land next to a lake, in km, so that lakes can be wider than their rivers.
pub fn beside(land: &Refinement, depth: usize) -> f32 {
    BESIDE * land.kilometres(depth) as f32
}

/// A node of a new lake.
pub struct Part {
    pub node: usize,
    /// Half the width of the lake around the river, in cells.
    pub half_width: f32,
}

/// Turns nodes of rivers into lakes, and returns these nodes. Nodes are exact except for [`REACH`] at the edge. Drawn
/// rivers do not become lakes, and lakes keep away from them.
pub fn begin(land: &Refinement, level: &mut Level, drawn: &Passages) -> Vec<Part> {
    let found = Outlets::new(land, level);
    let steepest = (MAX_SLOPE * land.cell_of(level.depth)) as f32;
    // All lakes are found from the level as it was, so that they do not depend on each other.
    let (heights, mut receivers) = (level.height.clone(), level.receiver.clone());
    drawn.left().for_each(|(q, _)| receivers[q] = NONE);
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

/// Whether no neighbor of a node is water.
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

    /// Whether there is neither standing water nor another candidate within the length of a lake downstream. The lake
    /// of such a candidate could reach this node.
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

/// The frequency of lakes around a node, 0 to 1.
fn frequency(land: &Refinement, level: &Level, q: usize) -> f64 {
    let (x, y) = level.place(q);
    let kilometres = |index: i64, share: f32| land.metres(level.depth, index, share) * 1e-3;
    let (east, south) = (kilometres(x, level.east[q]), kilometres(y, level.south[q]));
    let [wide, fine] = DISTRICTS.map(|wavelength| noise(land.seed, 8, east / wavelength, south / wavelength));
    let uplift = f64::from(level.uplift[q]);
    let mountains = IN_MOUNTAINS * smooth_step(HILLS, MOUNTAINS, uplift);
    let district = smooth_step(SPARSE, FREQUENT, wide + FINE_DISTRICTS * fine + mountains).max(LEAST);
    let relief = smooth_step(PLAINS, HILLS, uplift);
    district * (CHANCE_IN_PLAINS + (1.0 - CHANCE_IN_PLAINS) * relief)
}

/// The nodes on land whose receiver is `q`.
fn donors(level: &Level, q: usize) -> impl Iterator<Item = usize> {
    STEPS.iter().enumerate().filter_map(move |(code, step)| {
        let donor = level.neighbor(q, *step)?;
        (usize::from(level.receiver[donor]) == (code + 4) & 7).then_some(donor)
    })
}
