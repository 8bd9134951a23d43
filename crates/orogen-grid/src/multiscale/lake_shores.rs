//! Shores of lakes with an outlet: the shapes of new lakes, and the height of the land around lakes.

use super::carve::Carved;
use super::children::Children;
use super::drainage::{FREE, WATER};
use super::lakes::{BESIDE, Part, WIDEST, is_lake};
use super::level::Level;
use super::refinement::Refinement;
use super::stencil::Extent;
use crate::hydrology::direction::{NONE, STEPS};
use std::f32::consts::SQRT_2;

/// A lake extends only to points whose distance to its own river is less than this factor times the distance to a lower
/// river, so that there is a ridge between them.
const NEARER: f32 = 0.6;

/// Number of cells around a lake within which the land is not much lower than the lake, so that the lake has no wall
/// around it.
pub const RIM: usize = 3;

/// Slope of this land away from the lake, and its height above the lake at the shore, in metres.
const RIM_SLOPE: f32 = 0.2;
const RIM_HEIGHT: f32 = 0.1;

/// The minimum height where there is no limit.
pub const ANYTHING: f32 = -1e30;

/// Places the shores of new lakes at a distance from the links between their nodes.
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

/// The position of the receiver of a lake's node, from the corner of the node's cell, in cells; `None` if it is not in
/// the same lake.
fn link(level: &Level, q: usize) -> Option<[f32; 2]> {
    let step = STEPS[usize::from(level.receiver[q] & 7)];
    let to = level.neighbor(q, step)?;
    let is_same = is_lake(level.receiver[to]) && level.height[to] == level.height[q];
    is_same.then(|| [level.east[to] + step.0 as f32, level.south[to] + step.1 as f32])
}

/// The links of rivers that are near a lake's node and lower than the lake, as positions from the corner of the node's
/// cell, in cells.
fn lower_rivers(level: &Level, q: usize) -> Vec<[[f32; 2]; 2]> {
    let reach = WIDEST as isize;
    let around = (-reach..=reach).flat_map(|south| (-reach..=reach).map(move |east| (east, south)));
    let mut found = Vec::new();
    for (east, south) in around {
        let Some(near) = level.neighbor(q, (east, south)) else { continue };
        let is_lower = level.receiver[near] < NONE && level.height[near] < level.height[q];
        let Some(to) = level.downstream(near).filter(|_| is_lower && level.area[near] > 1.5) else { continue };
        let step = STEPS[usize::from(level.receiver[near])];
        let place =
            |node: usize, east: isize, south: isize| [level.east[node] + east as f32, level.south[node] + south as f32];
        found.push([place(near, east, south), place(to, east + step.0, south + step.1)]);
    }
    found
}

/// The minimum heights of land around lakes with an outlet, exact except for [`RIM`] cells at the edge; [`ANYTHING`]
/// elsewhere. Empty if there is no lake.
pub fn rims(land: &Refinement, depth: usize, extent: Extent, carved: &Carved) -> Vec<f32> {
    let has_outlet = |q: usize| carved.fixed[q] == WATER && carved.receiver[q] < WATER;
    if land.lakes == 0.0 || !(0..extent.len()).any(has_outlet) {
        return Vec::new();
    }
    let fall = RIM_SLOPE * land.cell_of(depth) as f32;
    let mut least: Vec<f32> = (0..extent.len())
        .map(|q| if has_outlet(q) { carved.height[q] + RIM_HEIGHT + fall } else { ANYTHING })
        .collect();
    let mut next = least.clone();
    let mut inner = extent;
    for step in 0..RIM {
        inner = inner.shrunk(1);
        for j in inner.rows() {
            let around = inner.around(&least, j);
            for (k, out) in inner.row_mut(&mut next, j).iter_mut().enumerate() {
                for (code, there) in around.iter().enumerate() {
                    // All cells at the shore have the same height, so that no water leaves through them.
                    let distance = if step > 0 && code & 1 == 1 { SQRT_2 } else { 1.0 };
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

/// Raises land around lakes that has fallen below its minimum height since `before`.
pub fn hold(rims: &[f32], before: &[f32], heights: &mut [f32]) {
    for ((height, &before), &least) in heights.iter_mut().zip(before).zip(rims) {
        *height = height.max(before.min(least));
    }
}

/// The distance of the point `at` from the line between two others.
fn distance(at: [f32; 2], from: [f32; 2], to: [f32; 2]) -> f32 {
    let (along, away) = ([to[0] - from[0], to[1] - from[1]], [at[0] - from[0], at[1] - from[1]]);
    let square = along[0] * along[0] + along[1] * along[1];
    let share = (along[0] * away[0] + along[1] * away[1]) / square.max(1e-6);
    let share = share.clamp(0.0, 1.0);
    let (x, y) = (away[0] - share * along[0], away[1] - share * along[1]);
    (x * x + y * y).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_land_at_the_shore_is_above_the_lake() {
        let extent = Extent { width: 9, height: 9, inset: 0 };
        let lake = 4 * 9 + 4;
        let plane = |value: f32| vec![value; extent.len()];
        let (mut height, mut receiver, mut fixed) = (plane(50.0), plane(0.0), plane(FREE));
        (height[lake], receiver[lake], fixed[lake]) = (100.0, 2.0, WATER);
        // The outlet keeps its height.
        fixed[lake + 9] = 2.0;
        let carved = Carved { height, area: plane(1.0), receiver, fixed, distances: None, drawn: Vec::new() };
        let land = Refinement { lakes: 1.0, ..Refinement::default() };
        let least = rims(&land, land.levels, extent, &carved);
        for (east, south) in STEPS.into_iter().filter(|step| *step != (0, 1)) {
            let near = lake.wrapping_add_signed(9 * south + east);
            assert!(least[near] > 100.0, "{} m at {east}, {south}", least[near]);
        }
        assert!(least[lake + 9] == ANYTHING && least[lake] == ANYTHING);
        assert!(least[lake + 2] < 100.0 && least[lake + 2] > 50.0 && least[lake + 4] == ANYTHING);
        assert!(rims(&Refinement::default(), 11, extent, &carved).is_empty());
    }
}
