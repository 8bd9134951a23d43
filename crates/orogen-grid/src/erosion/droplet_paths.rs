//! The paths of a batch of droplets over fixed ground.

use crate::error::Result;
use crate::grid::Grid;
use crate::progress::Progress;
use crate::random::{STEP, mix64};
use orogen_simd::{Body, Simd, dispatch};
use std::ops::Range;

/// Parameters that are common to all droplets.
#[derive(Debug, Clone, Copy)]
pub struct Step {
    /// Seed of the droplets.
    pub seed: u64,
    /// Expected number of droplets that start in a cell.
    pub expected: f64,
    /// Maximum length of a path, in cells.
    pub steps: usize,
    /// Inertia: the share of the previous direction that is kept, 0 to 1.
    pub inertia: f32,
    /// Capacity per m/s on a vertical slope, in metres over one cell.
    pub capacity: f32,
    /// The inverse of the cell size in metres.
    pub per_cell: f32,
    /// Minimum slope for the capacity.
    pub least_slope: f32,
    /// Share of the unused capacity that is eroded.
    pub erosion: f32,
    /// Share of the excess sediment that is deposited.
    pub deposition: f32,
    /// Share of the water that remains after a step of one cell.
    pub left: f32,
    /// Gravity, in m/s^2.
    pub gravity: f32,
}

/// The output of a band's droplets, in units, for rows from `first`.
pub struct Sums<'a> {
    /// The first row.
    pub first: usize,
    /// Eroded amounts.
    pub cut: &'a mut [i64],
    /// Deposited amounts.
    pub laid: &'a mut [i64],
}

/// Metres per unit of the sums. Fine enough for the last share of a droplet, and 2^62 units are higher than any ground.
pub const UNIT: f64 = 1.0 / (1u64 << 36) as f64;

/// Number of columns over which droplets run at a time, so that the ground stays in the cache.
const COLUMNS: usize = 128;

/// Initial speed of all droplets, in m/s.
const START: f32 = 1.0;

/// Droplets between two checks for cancellation.
const UNCHECKED: u64 = 64;

/// Runs all droplets that start in `rows`. The unit of `progress` is rows.
///
/// # Errors
/// If the work is cancelled.
pub fn run(heights: &Grid, step: &Step, rows: Range<usize>, sums: Sums, progress: &Progress) -> Result<()> {
    dispatch(Batch { heights, step, rows, sums, progress })
}

struct Batch<'a> {
    heights: &'a Grid,
    step: &'a Step,
    rows: Range<usize>,
    sums: Sums<'a>,
    progress: &'a Progress,
}

impl Body for Batch<'_> {
    type Output = Result<()>;

    #[inline(always)]
    fn run<S: Simd>(mut self, _: S) -> Result<()> {
        let window = *self.heights.window();
        for left in (0..window.width).step_by(COLUMNS) {
            let right = window.width.min(left + COLUMNS);
            for j in self.rows.clone() {
                self.progress.check()?;
                for i in left..right {
                    let (x, y) = ((window.x + i as i64) as u64, (window.y + j as i64) as u64);
                    let chance = mix64(self.step.seed ^ x.wrapping_mul(STEP));
                    let chance = mix64(chance ^ y.wrapping_mul(0xD1B5_4A32_D192_ED03));
                    let count = self.step.expected + (chance >> 11) as f64 / (1u64 << 53) as f64;
                    for drop in 0..count as u64 {
                        if drop % UNCHECKED == UNCHECKED - 1 {
                            self.progress.check()?;
                        }
                        let place = mix64(chance ^ (drop + 1).wrapping_mul(0xE703_7ED1_A0B4_28DB));
                        let start = [place >> 40, place << 24 >> 40].map(|share| share as f32 / (1u32 << 24) as f32);
                        go(self.heights, self.step, [i, j], start, &mut self.sums);
                    }
                }
            }
            self.progress.advance(self.rows.len() as f64 * (right - left) as f64 / window.width as f64);
        }
        Ok(())
    }
}

/// The four corners around a position in a cell.
struct Corners {
    nw: f32,
    ne: f32,
    sw: f32,
    se: f32,
}

impl Corners {
    #[inline(always)]
    fn height(&self, [x, y]: [f32; 2]) -> f32 {
        let north = self.nw + (self.ne - self.nw) * x;
        let south = self.sw + (self.se - self.sw) * x;
        north + (south - north) * y
    }

    /// The gradient per cell, to the east and to the south.
    #[inline(always)]
    fn gradient(&self, [x, y]: [f32; 2]) -> [f32; 2] {
        let (north, south) = (self.ne - self.nw, self.se - self.sw);
        let (west, east) = (self.sw - self.nw, self.se - self.ne);
        [north + (south - north) * y, west + (east - west) * x]
    }
}

/// Runs one droplet from a position in cell (i, j).
#[inline(always)]
fn go(heights: &Grid, step: &Step, [mut i, mut j]: [usize; 2], mut at: [f32; 2], sums: &mut Sums) {
    let (width, data) = (heights.width(), heights.data());
    if i + 1 >= width || j + 1 >= heights.height() {
        return;
    }
    let corners = |i: usize, j: usize| {
        let north = &data[j * width + i..][..2];
        let south = &data[(j + 1) * width + i..][..2];
        Corners { nw: north[0], ne: north[1], sw: south[0], se: south[1] }
    };
    let mut around = corners(i, j);
    let mut here = around.height(at);
    let (mut way, mut speed, mut water, mut carried) = ([0.0f32; 2], START, 1.0f32, 0.0f32);
    for _ in 0..step.steps {
        let rise = around.gradient(at);
        let turned = [0, 1].map(|k| step.inertia * way[k] - (1.0 - step.inertia) * rise[k] * step.per_cell);
        let length = (turned[0] * turned[0] + turned[1] * turned[1]).sqrt();
        // Level ground, or a corner without a height.
        if !(1e-9..f32::INFINITY).contains(&length) {
            break;
        }
        let scale = 1.0 / length;
        way = turned.map(|part| part * scale);
        let moved = [at[0] + way[0], at[1] + way[1]];
        // A step is one cell long, so the next position is in -1 .. 2, and truncation after adding 1 is equivalent to
        // rounding down.
        let whole = moved.map(|place| (place + 1.0) as i32 - 1);
        let (east, south) = (i.wrapping_add_signed(whole[0] as isize), j.wrapping_add_signed(whole[1] as isize));
        // A position before the first column or row wraps around to a value beyond the last one.
        if east >= width - 1 || south >= heights.height() - 1 {
            break;
        }
        let next = [moved[0] - whole[0] as f32, moved[1] - whole[1] as f32];
        let ahead = corners(east, south);
        let there = ahead.height(next);
        if !there.is_finite() {
            break;
        }
        let drop = here - there;
        let slope = drop * step.per_cell;
        let could = slope.max(step.least_slope) * speed * water * step.capacity;
        if drop < 0.0 {
            let laid = carried.min(-drop);
            carried -= laid;
            spread(&mut *sums.laid, sums.first, width, [i, j], at, laid);
        } else if carried > could {
            let laid = (carried - could) * step.deposition;
            carried -= laid;
            spread(&mut *sums.laid, sums.first, width, [i, j], at, laid);
        } else {
            let cut = ((could - carried) * step.erosion).min(drop);
            carried += cut;
            spread(&mut *sums.cut, sums.first, width, [i, j], at, cut);
        }
        speed = (speed * speed + step.gravity * drop).max(0.0).sqrt();
        water *= step.left;
        (i, j, at, here, around) = (east, south, next, there, ahead);
    }
    spread(&mut *sums.laid, sums.first, width, [i, j], at, carried);
}

/// Adds an amount, in metres over one cell, to the four corners around a position.
#[inline(always)]
fn spread(sums: &mut [i64], first: usize, width: usize, [i, j]: [usize; 2], [x, y]: [f32; 2], amount: f32) {
    let amount = f64::from(amount) * (1.0 / UNIT);
    let (x, y) = (f64::from(x), f64::from(y));
    let (south, east) = (amount * y, x);
    let north = amount - south;
    let (ne, se) = (north * east, south * east);
    let from = (j - first) * width + i;
    let above = &mut sums[from..][..2];
    above[0] += units(north - ne);
    above[1] += units(ne);
    let below = &mut sums[from + width..][..2];
    below[0] += units(south - se);
    below[1] += units(se);
}

/// Rounds a value below 2^51 to the nearest integer. After adding 1.5 * 2^52, the integer is in the low bits of the
/// sum.
#[inline(always)]
fn units(amount: f64) -> i64 {
    const WHOLE: f64 = 6_755_399_441_055_744.0;
    (amount + WHOLE).to_bits().wrapping_sub(WHOLE.to_bits()) as i64
}
