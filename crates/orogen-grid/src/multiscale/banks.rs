//! Banks of rivers on the finest level: the ground next to a river is higher than its bed, so that steepest descent
//! stays in the river.

use super::drainage::WATER;
use super::stencil::Extent;
use orogen_simd::{Body, Simd, dispatch};

/// Drainage area, in cells, from which a river has banks.
const RIVER_AREA: f32 = 500.0;

/// Height of a bank above the bed, in metres.
const BANK: f32 = 0.3;

/// Minimum fall from a donor, in metres, that remains after raising.
const LEFT: f32 = 0.01;

/// One pass over the cells of `extent`: raises nodes next to rivers to the height of banks, but keeps them below their
/// donors.
pub fn raise_banks(
    extent: Extent,
    heights: &mut Vec<f32>,
    spare: &mut Vec<f32>,
    area: &[f32],
    receiver: &[f32],
    fixed: &[f32],
) {
    dispatch(Banks { extent, heights, area, receiver, fixed, out: spare });
    std::mem::swap(heights, spare);
}

struct Banks<'a> {
    extent: Extent,
    heights: &'a [f32],
    area: &'a [f32],
    receiver: &'a [f32],
    fixed: &'a [f32],
    out: &'a mut [f32],
}

impl Body for Banks<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, _: S) {
        let extent = self.extent;
        for j in extent.rows() {
            let around = [self.heights, self.area, self.receiver].map(|plane| extent.around(plane, j));
            let own = [self.heights, self.area, self.receiver, self.fixed].map(|plane| extent.row(plane, j));
            raise(own, around, extent.row_mut(self.out, j));
        }
    }
}

#[inline(always)]
fn raise([height, area, receiver, fixed]: [&[f32]; 4], around: [[&[f32]; 8]; 3], out: &mut [f32]) {
    let n = out.len();
    let (height, area, receiver, fixed) = (&height[..n], &area[..n], &receiver[..n], &fixed[..n]);
    let [heights, areas, receivers] = around.map(|planes| planes.map(|row| &row[..n]));
    for i in 0..n {
        let here = height[i];
        let (mut bank, mut lowest_donor) = (here, f32::INFINITY);
        for code in 0..8 {
            let there = heights[code][i];
            let river = (areas[code][i] >= RIVER_AREA) & (receivers[code][i] < WATER);
            bank = if river & (there + BANK > bank) { there + BANK } else { bank };
            let donor = receivers[code][i] == ((code + 4) & 7) as f32;
            lowest_donor = if donor & (there < lowest_donor) { there } else { lowest_donor };
        }
        let limit = lowest_donor - LEFT;
        let raised = if bank < limit { bank } else { limit };
        let raised = if raised > here { raised } else { here };
        let is_land = (receiver[i] < WATER) & (fixed[i] < WATER);
        out[i] = if (area[i] < RIVER_AREA) & is_land { raised } else { here };
    }
}
