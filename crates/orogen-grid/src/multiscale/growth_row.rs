//! The growth of one row of nodes. Each step is a loop over a row that reads one neighbor, so that it is vectorized.

use super::carve::UNKNOWN;
use super::drainage::{FREE, WATER};
use super::law::CONCAVITY;
use crate::erosion::power::power;
use std::f32::consts::{FRAC_1_SQRT_2, SQRT_2};

/// Half-width, in metres, of the floors of the smallest rivers that have floors. `growth.wgsl` has it, too.
pub const FLOOR_WIDTH: f32 = 75.0;

/// Maximum slope of a floor.
const FLOOR_SLOPE: f32 = 0.02;

/// Drainage area, in cells, below which slopes of the finest level rise equally in all directions.
const SLOPE_AREA: f32 = 30.0;

/// Constants of a level.
#[derive(Debug, Clone, Copy)]
pub struct Scale {
    /// The cell size in metres.
    pub cell: f32,
    /// Minimum rise over one cell, in metres, so that heights strictly fall.
    pub least_rise: f32,
    /// Inverse of the area of rivers with floors, in cells.
    pub floor_area: f32,
}

/// The values of a row of cells.
pub struct Own<'a> {
    pub height: &'a [f32],
    pub area: &'a [f32],
    pub fixed: &'a [f32],
    pub river: &'a [f32],
    pub stable: &'a [f32],
    /// Factor of the width of floors; empty without floors.
    pub width: &'a [f32],
    /// The minimum heights; empty without lakes.
    pub least: &'a [f32],
}

/// The values of the neighbors of a row of cells.
pub struct Around<'a> {
    pub height: [&'a [f32]; 8],
    pub fixed: [&'a [f32]; 8],
    /// Empty on the finest level, where nodes are on the lattice.
    pub distance: [&'a [f32]; 8],
    pub floor: [&'a [f32]; 8],
}

/// Intermediate results of a row.
#[derive(Default)]
pub struct Row {
    /// Rise over one cell by the law, and on a floor.
    rise: Vec<f32>,
    flat: Vec<f32>,
    /// Height below which a neighbor can become the receiver; for free nodes only.
    below: Vec<f32>,
    lowest: Vec<f32>,
    best: Vec<f32>,
    floor: Vec<f32>,
}

impl Row {
    fn resize(&mut self, cells: usize) {
        for plane in
            [&mut self.rise, &mut self.flat, &mut self.below, &mut self.lowest, &mut self.best, &mut self.floor]
        {
            plane.resize(cells, 0.0);
        }
    }
}

/// The new heights, receivers and floors of a row.
#[inline(always)]
pub fn grow<const FLOORS: bool, const REGULAR: bool>(
    row: &mut Row,
    own: &Own<'_>,
    around: &Around<'_>,
    scale: Scale,
    out: &mut [f32],
    receiver: &mut [f32],
    out_floor: &mut [f32],
) {
    let n = out.len();
    row.resize(n);
    let Row { rise, flat, below, lowest, best, floor } = row;
    rises(own, scale, &mut rise[..n], &mut flat[..n], &mut below[..n]);
    lowest[..n].fill(UNKNOWN);
    best[..n].fill(-1.0);
    floor[..n].fill(0.0);
    let law = Law { rise, flat, below, fixed: own.fixed, cell: scale.cell };
    for code in 0..8 {
        let there =
            Neighbor { height: around.height[code], distance: around.distance[code], floor: around.floor[code] };
        let there = Toward { there, code };
        let [lowest, best, floor] = [&mut lowest[..n], &mut best[..n], &mut floor[..n]];
        if code & 1 == 0 {
            offer::<FLOORS, REGULAR, false>(&law, &there, [&[]; 2], lowest, best, floor);
        } else {
            let beside = [around.fixed[code - 1], around.fixed[(code + 1) & 7]];
            offer::<FLOORS, REGULAR, true>(&law, &there, beside, lowest, best, floor);
        }
    }
    if REGULAR {
        for code in [0usize, 2, 4, 6] {
            for beside in [(code + 1) & 7, (code + 7) & 7] {
                let heights = [own.height, own.area, around.height[code], around.height[beside]];
                front(&law, heights, beside as f32, &mut lowest[..n], &mut best[..n], &mut floor[..n]);
            }
        }
    }
    for (lowest, least) in lowest[..n].iter_mut().zip(own.least) {
        *lowest = if *least > *lowest { *least } else { *lowest };
    }
    finish(own.height, lowest, best, out, receiver);
    if FLOORS {
        floors([own.area, own.width, own.fixed], floor, scale.floor_area, out_floor);
    }
}

/// The values of a row that apply to all its neighbors.
struct Law<'a> {
    rise: &'a [f32],
    flat: &'a [f32],
    below: &'a [f32],
    fixed: &'a [f32],
    cell: f32,
}

struct Neighbor<'a> {
    height: &'a [f32],
    distance: &'a [f32],
    floor: &'a [f32],
}

/// The neighbors of a row in one direction.
struct Toward<'a> {
    there: Neighbor<'a>,
    code: usize,
}

#[inline(always)]
fn rises(own: &Own<'_>, scale: Scale, rise: &mut [f32], flat: &mut [f32], below: &mut [f32]) {
    let n = rise.len();
    let (flat, below) = (&mut flat[..n], &mut below[..n]);
    let (height, area, fixed) = (&own.height[..n], &own.area[..n], &own.fixed[..n]);
    let (river, stable) = (&own.river[..n], &own.stable[..n]);
    for i in 0..n {
        let slope = river[i] * power(area[i], -CONCAVITY);
        let metres = slope * stable[i] / (slope + stable[i]) * scale.cell;
        let metres = if metres > scale.least_rise { metres } else { scale.least_rise };
        let on_floor = FLOOR_SLOPE * scale.cell;
        rise[i] = metres;
        flat[i] = if on_floor < metres { on_floor } else { metres };
        below[i] = if fixed[i] == FREE { height[i] } else { -UNKNOWN };
    }
}

/// Takes the height above the neighbors in one direction where it is the lowest so far. `beside` are the two cells next
/// to a diagonal. A link along the diagonal must not cross a river that leads from one of them to the other.
#[inline(always)]
fn offer<const FLOORS: bool, const REGULAR: bool, const DIAGONAL: bool>(
    law: &Law<'_>,
    toward: &Toward<'_>,
    beside: [&[f32]; 2],
    lowest: &mut [f32],
    best: &mut [f32],
    floor: &mut [f32],
) {
    let n = lowest.len();
    let (best, floor) = (&mut best[..n], &mut floor[..n]);
    let (rise, flat, below, fixed) = (&law.rise[..n], &law.flat[..n], &law.below[..n], &law.fixed[..n]);
    let there = &toward.there.height[..n];
    let distances = &toward.there.distance[..if REGULAR { 0 } else { n }];
    let floors = &toward.there.floor[..if FLOORS { n } else { 0 }];
    let regular = if DIAGONAL { SQRT_2 } else { 1.0 };
    let direct = toward.code as f32;
    let beside = beside.map(|row| &row[..if DIAGONAL { n } else { 0 }]);
    // The directions from each of the two cells next to the diagonal to the other.
    let across = [((toward.code + 2) & 7) as f32, ((toward.code + 6) & 7) as f32];
    for i in 0..n {
        let distance = if REGULAR { regular } else { distances[i] };
        let left = if FLOORS { floors[i] - distance * law.cell } else { 0.0 };
        let slope = if left > 0.0 { flat[i] } else { rise[i] };
        let candidate = there[i] + distance * slope;
        let crosses = DIAGONAL && (beside[0][i] == across[0]) | (beside[1][i] == across[1]);
        let possible = ((there[i] < below[i]) & !crosses) | (fixed[i] == direct);
        let better = possible & (candidate < lowest[i]);
        lowest[i] = if better { candidate } else { lowest[i] };
        best[i] = if better { direct } else { best[i] };
        if FLOORS {
            floor[i] = if better { left } else { floor[i] };
        }
    }
}

/// Takes the height of a front that passes between a neighbor and the lower neighbor in direction `beside`, where it is
/// the lowest so far.
#[inline(always)]
fn front(law: &Law<'_>, heights: [&[f32]; 4], beside: f32, lowest: &mut [f32], best: &mut [f32], floor: &mut [f32]) {
    let n = lowest.len();
    let (best, floor) = (&mut best[..n], &mut floor[..n]);
    let (rise, fixed) = (&law.rise[..n], &law.fixed[..n]);
    let [here, area, there, corner] = heights.map(|row| &row[..n]);
    for i in 0..n {
        let free = (fixed[i] == FREE) & (area[i] < SLOPE_AREA);
        let near = if free { rise[i] * FRAC_1_SQRT_2 } else { 0.0 };
        let fall = there[i] - corner[i];
        let square = rise[i] * rise[i] - fall * fall;
        let candidate = there[i] + (if square > 0.0 { square } else { 0.0 }).sqrt();
        let better = (fall > 0.0) & (fall < near) & (corner[i] < here[i]) & (candidate < lowest[i]);
        lowest[i] = if better { candidate } else { lowest[i] };
        best[i] = if better { beside } else { best[i] };
        floor[i] = if better { 0.0 } else { floor[i] };
    }
}

#[inline(always)]
fn finish(height: &[f32], lowest: &[f32], best: &[f32], out: &mut [f32], receiver: &mut [f32]) {
    let n = out.len();
    let (height, lowest, best, receiver) = (&height[..n], &lowest[..n], &best[..n], &mut receiver[..n]);
    for i in 0..n {
        out[i] = if lowest[i] < height[i] { lowest[i] } else { height[i] };
        receiver[i] = if best[i] >= 0.0 { best[i] } else { receiver[i] };
    }
}

/// The distance over which a river's floor continues, from its own size or from downstream.
#[inline(always)]
fn floors([area, width, fixed]: [&[f32]; 3], floor: &[f32], floor_area: f32, out: &mut [f32]) {
    let n = out.len();
    let (area, width, fixed, floor) = (&area[..n], &width[..n], &fixed[..n], &floor[..n]);
    for i in 0..n {
        let share = area[i] * floor_area;
        let own = FLOOR_WIDTH * share.sqrt() * width[i];
        let own = if (share > 1.0) & (fixed[i] < WATER) { own } else { 0.0 };
        out[i] = if floor[i] > own { floor[i] } else { own };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The direction that a free node chooses if its lowest neighbor is in the south-east and a river with this fixed
    /// receiver is in the east.
    fn receiver(river: f32) -> f32 {
        let heights = [[30.0], [5.0], [31.0], [40.0], [20.0], [40.0], [40.0], [40.0]];
        let fixed = [[river], [FREE], [FREE], [FREE], [FREE], [FREE], [FREE], [FREE]];
        let own = Own {
            height: &[100.0],
            area: &[1.0],
            fixed: &[FREE],
            river: &[1.0],
            stable: &[0.5],
            width: &[],
            least: &[],
        };
        let around = Around {
            height: heights.each_ref().map(|row| &row[..]),
            fixed: fixed.each_ref().map(|row| &row[..]),
            distance: [&[1.0]; 8],
            floor: [&[]; 8],
        };
        let (mut height, mut receiver) = ([0.0], [8.0]);
        let scale = Scale { cell: 60.0, least_rise: 0.01, floor_area: 0.0 };
        grow::<false, false>(&mut Row::default(), &own, &around, scale, &mut height, &mut receiver, &mut []);
        receiver[0]
    }

    #[test]
    fn streams_do_not_pass_under_rivers() {
        // A river to the south does not cross the link to the south-east; a river to the south-west does.
        assert_eq!((receiver(2.0), receiver(FREE)), (1.0, 1.0));
        assert_eq!(receiver(3.0), 4.0);
    }
}
