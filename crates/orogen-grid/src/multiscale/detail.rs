//! Detail levels, below the finest level of valleys. Their hillsides are as steep as on that level. Soil smooths gentle
//! hillsides, and steep ones are rough rock. Only gullies are new: if valleys grew further by the law of slopes, all
//! land would become as steep as rock can stand.

use super::carve::Carved;
use super::law::{CONCAVITY, Law, STABLE, STABLE_EXPONENT, river_slope, stable_slope};
use super::level::Level;
use super::refinement::Refinement;
use super::stencil::Extent;
use super::{creep, hash, rock, scree};
use crate::erosion::power::power;
use crate::hydrology::direction::{NONE, STEPS};
use std::f32::consts::{E, SQRT_2};

/// The part of its cell within which a node of the finest level of valleys is displaced from the lattice.
const DISPLACED: f32 = 0.5;

/// Drainage area in cells up to which the slope to the receiver counts as the slope of a hillside. The larger the area
/// beyond it, the less a node counts.
const HILLSIDE_AREA: f32 = 8.0;

/// Weights of river nodes and of water nodes in averages with hillsides.
const RIVER_WEIGHT: f32 = 0.01;
const WATER_WEIGHT: f32 = 0.001;

/// The minimum stable slope, and the maximum relative to the law of slopes.
const MIN_STABLE: f32 = 1e-3;
const MAX_STABLE: f32 = 1.5;

/// Drainage area in m^2 below which rivers of detail levels choose their receivers again. Otherwise two parallel rivers
/// at different heights would have a wall between them.
const FREE_AREA: f64 = 1e6;

/// Maximum number of passes of creep.
const CREEP_PASSES: usize = 2;

/// Turns nodes of the finest level of valleys into the nodes that detail levels begin with: off the lattice, with
/// uplift over erodibility in `variation` and the logarithm of the stable slope in `uplift`. Values are exact except
/// for [`scree::REACH`] nodes at the edge.
pub fn begin(land: &Refinement, level: &mut Level) {
    let mut stable = stable_slopes(land, level);
    let mut variation = std::mem::take(&mut level.variation);
    scree::lay(level, &mut stable, &mut variation);
    level.variation = variation;
    for (q, stable) in stable.into_iter().enumerate() {
        let (x, y) = level.place(q);
        let bits = hash::node(land.seed, level.depth, x, y, 11);
        level.east[q] = 0.5 + DISPLACED * (hash::unit(bits) - 0.5);
        level.south[q] = 0.5 + DISPLACED * (hash::unit(bits << 24) - 0.5);
        level.variation[q] += level.uplift[q];
        level.uplift[q] = libm::log(f64::from(stable)) as f32;
    }
}

/// The stable slope t with which the law gives the slope from each node to its receiver, averaged over 3 x 3 nodes.
fn stable_slopes(land: &Refinement, level: &Level) -> Vec<f32> {
    let width = level.window.width;
    let kilometres = land.kilometres(level.depth);
    let river_factor = river_slope(land, kilometres * kilometres) as f32;
    let cell = land.cell_of(level.depth) as f32;
    let by_law = stable_slope(land);
    // The value at each node and its weight.
    let mut own = vec![(0.0, 0.0); level.window.len()];
    for q in level.inner(1) {
        let logarithm = level.variation[q] + level.uplift[q];
        let law = by_law * power(E, STABLE_EXPONENT * logarithm);
        let (area, receiver) = (level.area[q].max(1.0), level.receiver[q]);
        own[q] = (law, WATER_WEIGHT);
        if receiver < NONE {
            let (east, south) = STEPS[usize::from(receiver)];
            let to = q.wrapping_add_signed(south * width as isize + east);
            let distance = if receiver & 1 == 1 { SQRT_2 } else { 1.0 };
            let slope = (level.height[q] - level.height[to]) / (distance * cell);
            let river = river_factor * power(E, logarithm) * power(area, -CONCAVITY);
            // 1 / slope = 1 / river + 1 / stable.
            let stable = slope * river / (river - slope).max(0.05 * river);
            let (stable, most) = if area > HILLSIDE_AREA { (slope, law) } else { (stable, MAX_STABLE * law) };
            let share = area / HILLSIDE_AREA;
            own[q] = (stable.clamp(MIN_STABLE, most.max(MIN_STABLE)), RIVER_WEIGHT + 1.0 / (1.0 + share * share));
        }
    }
    let mut stable = vec![STABLE; level.window.len()];
    for q in level.inner(2) {
        let (mut sum, mut weights) = (0.0, 0.0);
        for (row, south) in [(q - width, 1.0), (q, 2.0), (q + width, 1.0)] {
            for (o, east) in [(row - 1, 1.0), (row, 2.0), (row + 1, 1.0)] {
                let (value, weight) = own[o];
                sum += south * east * weight * value;
                weights += south * east * weight;
            }
        }
        stable[q] = sum / weights;
    }
    stable
}

/// Drainage area, in cells, below which rivers choose their receivers again.
pub fn free_area(cell: f64) -> f32 {
    (FREE_AREA / (cell * cell)) as f32
}

/// Lets rivers with a small area choose their receivers again. Where their slopes are steeper than the law, they keep
/// them. Otherwise they would fall by less than on the coarser level, and a fall that moves upstream by a few cells on
/// each level would leave steps.
pub fn free_rivers(land: &Refinement, depth: usize, carved: &mut Carved, extent: Extent, law: &mut Law) {
    let cell = land.cell_of(depth);
    let free_area = free_area(cell);
    let (inner, width) = (extent.shrunk(1), extent.width);
    if let Some(distances) = &carved.distances {
        for j in inner.rows() {
            let around = distances.around(inner, j);
            for (k, q) in
                inner.columns().map(|i| j * width + i).enumerate().filter(|(_, q)| carved.area[*q] < free_area)
            {
                let Some(to) = downstream(carved, extent, q) else { continue };
                let distance = around[carved.fixed[q] as usize][k] * cell as f32;
                let slope = (carved.height[q] - carved.height[to]) / distance;
                let river = law.river[q] * power(carved.area[q], -CONCAVITY);
                if slope > river * law.stable[q] / (river + law.stable[q]) {
                    // A river this steep is limited by the stable slope alone.
                    (law.river[q], law.stable[q]) = (1e12, slope);
                }
            }
        }
    }
    carved.free(free_area);
}

/// The receiver of a river's cell; `None` if the cell has no river.
fn downstream(carved: &Carved, extent: Extent, q: usize) -> Option<usize> {
    let code = carved.fixed[q];
    let (east, south) = *STEPS.get(if code >= 0.0 { code as usize } else { usize::MAX })?;
    Some(q.wrapping_add_signed(south * extent.width as isize + east))
}

/// Number of passes of creep on detail levels.
pub fn creep_passes(land: &Refinement) -> usize {
    creep::creep_passes(land.creep).min(CREEP_PASSES)
}

/// Factors of creep: 1 for soil, less on rock slopes.
pub fn creep_factors(law: &Law) -> Vec<f32> {
    law.stable.iter().map(|stable| rock::creep_factor(*stable)).collect()
}
