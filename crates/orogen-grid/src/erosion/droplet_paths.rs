//! The ways of a batch of droplets over ground that does not change meanwhile.

use crate::error::Result;
use crate::grid::Grid;
use crate::progress::Progress;
use orogen_simd::{Body, Simd, dispatch};
use std::ops::Range;

/// What does not differ between droplets.
#[derive(Debug, Clone, Copy)]
pub struct Step {
    /// Which droplets.
    pub seed: u64,
    /// How many start in a cell, on average.
    pub expected: f64,
    /// How many cells each goes at most.
    pub steps: usize,
    /// The share of its direction that it keeps.
    pub inertia: f32,
    /// What is carried on a sheer slope for each m/s, in metres over one cell.
    pub capacity: f32,
    /// One over the cell.
    pub per_cell: f32,
    /// The slope that capacity counts at least.
    pub least_slope: f32,
    /// The share of what could still be carried that is cut.
    pub erosion: f32,
    /// The share of what is too much that is laid down.
    pub deposition: f32,
    /// The share of the water that is left after a cell.
    pub left: f32,
    /// m/s^2.
    pub gravity: f32,
}

/// Where a band's droplets write: rows from `first` on, in units.
pub struct Sums<'a> {
    /// The first row.
    pub first: usize,
    /// What is cut.
    pub cut: &'a mut [i64],
    /// What is laid down.
    pub laid: &'a mut [i64],
}

/// Metres in a unit of the sums: so fine that a drop's last share still counts, and 2^62 of them are higher than any
/// ground.
pub const UNIT: f64 = 1.0 / (1u64 << 36) as f64;

/// Droplets go side by side over so many columns at a time: the ground they run over stays in cache.
const COLUMNS: usize = 128;

/// Speed at which all start, m/s.
const START: f32 = 1.0;

/// Droplets between two looks at whether the work is still wanted.
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
                    let chance = mix(self.step.seed ^ x.wrapping_mul(0x9E37_79B9_7F4A_7C15));
                    let chance = mix(chance ^ y.wrapping_mul(0xD1B5_4A32_D192_ED03));
                    let count = self.step.expected + (chance >> 11) as f64 / (1u64 << 53) as f64;
                    for drop in 0..count as u64 {
                        if drop % UNCHECKED == UNCHECKED - 1 {
                            self.progress.check()?;
                        }
                        let place = mix(chance ^ (drop + 1).wrapping_mul(0xE703_7ED1_A0B4_28DB));
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

/// splitmix64's finaliser (Steele, Lea and Flood 2014).
#[inline(always)]
fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

/// The corners around a place in a cell.
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

    /// Rise a cell, east and south.
    #[inline(always)]
    fn gradient(&self, [x, y]: [f32; 2]) -> [f32; 2] {
        let (north, south) = (self.ne - self.nw, self.se - self.sw);
        let (west, east) = (self.sw - self.nw, self.se - self.ne);
        [north + (south - north) * y, west + (east - west) * x]
    }
}

/// One droplet, from a place in cell (i, j) on.
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
        if length < 1e-9 {
            break;
        }
        let scale = 1.0 / length;
        way = turned.map(|part| part * scale);
        let moved = [at[0] + way[0], at[1] + way[1]];
        // A step is a cell long: the place ahead is in -1 up to 2, and truncating after adding 1 is the floor.
        let whole = moved.map(|place| (place + 1.0) as i32 - 1);
        let (east, south) = (i.wrapping_add_signed(whole[0] as isize), j.wrapping_add_signed(whole[1] as isize));
        // Before the first column or row is far beyond the last.
        if east >= width - 1 || south >= heights.height() - 1 {
            break;
        }
        let next = [moved[0] - whole[0] as f32, moved[1] - whole[1] as f32];
        let ahead = corners(east, south);
        let there = ahead.height(next);
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

/// Adds an amount, in metres over one cell, to the four corners around a place.
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

/// The nearest whole number, for what is below 2^51: added to 1.5 * 2^52 it stands in the low bits of the sum.
#[inline(always)]
fn units(amount: f64) -> i64 {
    const WHOLE: f64 = 6_755_399_441_055_744.0;
    (amount + WHOLE).to_bits().wrapping_sub(WHOLE.to_bits()) as i64
}
