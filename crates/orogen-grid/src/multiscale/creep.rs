//! Soil creep on the finest level: slopes become smooth, and every node stays above its receiver.

use super::drainage::{FREE, WATER};
use super::refinement::Refinement;
use super::stencil::Extent;
use orogen_simd::{Body, Simd, dispatch};
use std::f32::consts::FRAC_1_SQRT_2;

/// Share of the difference to the mean of the neighbors by which a pass moves a height.
const RATE: f32 = 0.8;

/// Variance of the average of the neighbors, in square cells.
const SPREAD: f64 = 0.6;

/// Number of passes that smooth land over a distance in cells.
pub fn creep_passes(distance: f64) -> usize {
    let variance = distance * distance;
    (variance / (SPREAD * f64::from(RATE))).round() as usize
}

/// Drainage area in cells at which the rate is halved.
const CHANNEL_AREA: f32 = 300.0;

/// Limits of creep.
#[derive(Debug, Clone, Copy)]
pub struct Kept {
    /// Minimum fall to the receiver that remains, in metres.
    pub fall: f32,
    /// Drainage area in cells from which rivers cut down instead of creeping.
    pub cut_area: f32,
}

impl Kept {
    /// The limits on the finest level of valleys, or on a detail level, where the rivers already exist.
    pub fn on(land: &Refinement, depth: usize) -> Kept {
        if land.is_detail(depth) {
            Kept { fall: land.least_rise(depth), cut_area: f32::INFINITY }
        } else {
            Kept { fall: 0.02, cut_area: 1400.0 }
        }
    }
}

/// The depth in metres that rivers cut in a pass, as long as heights still fall along them.
const CUT: f32 = 1.5;

/// Maximum share of the fall to its receiver by which a node is lowered in a pass.
const LOWERED: f32 = 0.5;

/// The planes of a level that creep reads in addition to the heights.
#[derive(Clone, Copy)]
pub struct Hillsides<'a> {
    pub area: &'a [f32],
    pub receiver: &'a [f32],
    /// Receivers that must not change (see [`super::carve::Carved::fixed`]); water keeps its height.
    pub fixed: &'a [f32],
    /// Factor of the rate.
    pub factor: &'a [f32],
}

/// One pass of creep over the cells of `extent`.
pub fn creep(extent: Extent, heights: &mut Vec<f32>, spare: &mut Vec<f32>, slopes: Hillsides, kept: Kept) {
    dispatch(Creep { extent, heights, slopes, kept, out: spare });
    std::mem::swap(heights, spare);
}

struct Creep<'a> {
    extent: Extent,
    heights: &'a [f32],
    slopes: Hillsides<'a>,
    kept: Kept,
    out: &'a mut [f32],
}

impl Body for Creep<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, _: S) {
        let extent = self.extent;
        for j in extent.rows() {
            let Hillsides { area, receiver, fixed, factor } = self.slopes;
            let (heights, receivers) = (extent.around(self.heights, j), extent.around(receiver, j));
            let own = [self.heights, area, receiver, fixed, factor].map(|plane| extent.row(plane, j));
            smooth(own, heights, receivers, self.kept, extent.row_mut(self.out, j));
        }
    }
}

/// A node is lowered by at most a share of the fall to its receiver. It is raised by at most the rest of that share of
/// the fall from its lowest donor, so that donors stay above it.
#[inline(always)]
fn smooth(
    [height, area, receiver, fixed, factor]: [&[f32]; 5],
    heights: [&[f32]; 8],
    receivers: [&[f32]; 8],
    kept: Kept,
    out: &mut [f32],
) {
    let n = out.len();
    let (height, area, receiver) = (&height[..n], &area[..n], &receiver[..n]);
    let (fixed, factor) = (&fixed[..n], &factor[..n]);
    let (heights, receivers) = (heights.map(|row| &row[..n]), receivers.map(|row| &row[..n]));
    for i in 0..n {
        let here = height[i];
        let (mut sides, mut corners) = (0.0, 0.0);
        let mut down = 0.0;
        let mut up = f32::INFINITY;
        for code in 0..8 {
            let there = heights[code][i];
            if code & 1 == 0 {
                sides += there;
            } else {
                corners += there;
            }
            down = if receiver[i] == code as f32 { here - there } else { down };
            let donor = receivers[code][i] == ((code + 4) & 7) as f32;
            up = if donor & (there - here < up) { there - here } else { up };
        }
        let (down, up) = (down - kept.fall, up - kept.fall);
        let lower = if down > 0.0 { -LOWERED * down } else { 0.0 };
        let upper = if up > 0.0 { (1.0 - LOWERED) * up } else { 0.0 };
        let rate = RATE * factor[i] * CHANNEL_AREA / (CHANNEL_AREA + area[i]);
        let change = rate * ((4.0 * sides + corners) * (1.0 / 20.0) - here);
        let change = if area[i] < kept.cut_area { change } else { -CUT };
        let change = if change > lower { change } else { lower };
        let change = if change < upper { change } else { upper };
        let is_land = (receiver[i] < WATER) & (fixed[i] < WATER);
        out[i] = if is_land { here + change } else { here };
    }
}

/// Directs free nodes along the steepest descent.
pub fn steepest(extent: Extent, heights: &[f32], fixed: &[f32], receiver: &mut [f32]) {
    dispatch(Steepest { extent, heights, fixed, receiver });
}

struct Steepest<'a> {
    extent: Extent,
    heights: &'a [f32],
    fixed: &'a [f32],
    receiver: &'a mut [f32],
}

impl Body for Steepest<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, _: S) {
        let extent = self.extent;
        for j in extent.rows() {
            let own = [extent.row(self.heights, j), extent.row(self.fixed, j)];
            descend(own, extent.around(self.heights, j), extent.row_mut(self.receiver, j));
        }
    }
}

#[inline(always)]
fn descend([height, fixed]: [&[f32]; 2], heights: [&[f32]; 8], receiver: &mut [f32]) {
    let n = receiver.len();
    let (height, fixed, heights) = (&height[..n], &fixed[..n], heights.map(|row| &row[..n]));
    for i in 0..n {
        let mut steepest = 0.0;
        let mut best = receiver[i];
        for (code, there) in heights.iter().enumerate() {
            let fall = height[i] - there[i];
            let fall = if code & 1 == 1 { fall * FRAC_1_SQRT_2 } else { fall };
            let better = fall > steepest;
            steepest = if better { fall } else { steepest };
            best = if better { code as f32 } else { best };
        }
        receiver[i] = if fixed[i] == FREE { best } else { receiver[i] };
    }
}
