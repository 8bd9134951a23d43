//! Growth of the land between rivers: passes in which heights fall to the steady state of the law over the lowest neighbour.

use super::carve::{FREE, UNKNOWN};
use super::distances::Distances;
use super::law::{CONCAVITY, Law};
use super::stencil::Extent;
use crate::erosion::power::power;
use orogen_simd::{Body, Simd, dispatch};
use std::f32::consts::{FRAC_1_SQRT_2, SQRT_2};

/// Drainage area, in km^2, from which rivers have floors, and the half-width of a floor there in metres.
const FLOOR_AREA: f64 = 5.0;
const FLOOR_WIDTH: f32 = 100.0;

/// Greatest slope of a floor.
const FLOOR_SLOPE: f32 = 0.02;

/// Smallest rise between two nodes, in metres: heights fall strictly.
const MIN_RISE: f32 = 0.004;

/// Drainage area, in cells, below which slopes of the finest level rise in all directions alike.
const SLOPE_AREA: f32 = 30.0;

/// Drainage area, in km^2, from which a river of the finest level lies deeper than its banks, and its depth in metres at 5 km^2 more.
const BANK_AREA: f64 = 0.5;
const BANK_HEIGHT: f32 = 2.0;
const BANK_EXPONENT: f32 = 0.2;

/// The planes of a growing level.
pub struct Growth {
    pub height: Vec<f32>,
    pub area: Vec<f32>,
    pub receiver: Vec<f32>,
    /// Receivers that stay (see [`super::carve::Carved::fixed`]).
    pub fixed: Vec<f32>,
    /// Distance in metres over which the floor of a river downstream continues; empty without floors.
    floor: Vec<f32>,
    /// Depth of the river below its banks; empty except on the finest level.
    bank: Vec<f32>,
    next_height: Vec<f32>,
    next_floor: Vec<f32>,
    pub spare: Vec<f32>,
}

/// The distances between neighbours.
#[derive(Clone, Copy)]
pub enum Spacing<'a> {
    Irregular(&'a Distances),
    /// Nodes on the lattice, as on the finest level.
    Regular,
}

/// Numbers of a level.
#[derive(Clone, Copy)]
struct Scale {
    cell: f32,
    /// Inverse of the area of rivers with floors, in cells.
    floor_area: f32,
    bank_area: f32,
}

impl Growth {
    /// The nodes before growth.
    pub fn new(
        height: Vec<f32>,
        area: Vec<f32>,
        receiver: Vec<f32>,
        fixed: Vec<f32>,
        floors: bool,
        finest: bool,
    ) -> Growth {
        let cells = height.len();
        let plane = |wanted: bool| if wanted { vec![0.0; cells] } else { Vec::new() };
        Growth {
            next_height: height.clone(),
            spare: area.clone(),
            height,
            area,
            receiver,
            fixed,
            floor: plane(floors),
            bank: plane(finest),
            next_floor: plane(floors),
        }
    }

    /// One pass over the cells of `extent`, with nodes `cell` metres apart.
    pub fn pass(&mut self, extent: Extent, law: &Law, spacing: Spacing<'_>, cell: f64) {
        let square_kilometres = cell * cell * 1e-6;
        let scale = Scale {
            cell: cell as f32,
            floor_area: (square_kilometres / FLOOR_AREA) as f32,
            bank_area: square_kilometres as f32,
        };
        if !self.bank.is_empty() {
            dispatch(Banks { area: &self.area, bank: &mut self.bank, factor: scale.bank_area });
        }
        dispatch(Pass { growth: self, extent, law, spacing, scale });
        std::mem::swap(&mut self.height, &mut self.next_height);
        std::mem::swap(&mut self.floor, &mut self.next_floor);
    }
}

struct Banks<'a> {
    area: &'a [f32],
    bank: &'a mut [f32],
    factor: f32,
}

impl Body for Banks<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, _: S) {
        depths(self.area, self.factor, self.bank);
    }
}

#[inline(always)]
fn depths(area: &[f32], factor: f32, bank: &mut [f32]) {
    let area = &area[..bank.len()];
    for i in 0..bank.len() {
        let beyond = (area[i] * factor - BANK_AREA as f32) * (1.0 / FLOOR_AREA as f32);
        bank[i] = if beyond > 0.0 { BANK_HEIGHT * power(beyond, BANK_EXPONENT) } else { 0.0 };
    }
}

struct Pass<'a> {
    growth: &'a mut Growth,
    extent: Extent,
    law: &'a Law,
    spacing: Spacing<'a>,
    scale: Scale,
}

/// What a row of cells reads of itself.
struct Row<'a> {
    height: &'a [f32],
    area: &'a [f32],
    fixed: &'a [f32],
    river: &'a [f32],
    stable: &'a [f32],
    /// Factor of the floor's width.
    width: &'a [f32],
    bank: &'a [f32],
}

/// What a row of cells reads of its neighbours.
struct Around<'a> {
    height: [&'a [f32]; 8],
    distance: [&'a [f32]; 8],
    floor: [&'a [f32]; 8],
    bank: [&'a [f32]; 8],
}

impl Body for Pass<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        for j in self.extent.rows() {
            simd.run(OneRow {
                pass: &mut *self.growth,
                extent: self.extent,
                law: self.law,
                spacing: self.spacing,
                scale: self.scale,
                j,
            });
        }
    }
}

struct OneRow<'a> {
    pass: &'a mut Growth,
    extent: Extent,
    law: &'a Law,
    spacing: Spacing<'a>,
    scale: Scale,
    j: usize,
}

impl Body for OneRow<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, _: S) {
        let OneRow { pass: growth, extent, law, spacing, scale, j } = self;
        let nothing: [&[f32]; 8] = [&[]; 8];
        let (floors, finest) = (!growth.floor.is_empty(), !growth.bank.is_empty());
        let row = Row {
            height: extent.row(&growth.height, j),
            area: extent.row(&growth.area, j),
            fixed: extent.row(&growth.fixed, j),
            river: extent.row(&law.river, j),
            stable: extent.row(&law.stable, j),
            width: if floors { extent.row(&law.floor, j) } else { &[] },
            bank: if finest { extent.row(&growth.bank, j) } else { &[] },
        };
        let around = Around {
            height: extent.around(&growth.height, j),
            distance: match spacing {
                Spacing::Irregular(distances) => distances.around(extent, j),
                Spacing::Regular => nothing,
            },
            floor: if floors { extent.around(&growth.floor, j) } else { nothing },
            bank: if finest { extent.around(&growth.bank, j) } else { nothing },
        };
        let height = extent.row_mut(&mut growth.next_height, j);
        let receiver = extent.row_mut(&mut growth.receiver, j);
        if finest {
            let floor = extent.row_mut(&mut growth.next_floor, j);
            grow::<true, true>(&row, &around, scale, height, receiver, floor);
        } else if floors {
            let floor = extent.row_mut(&mut growth.next_floor, j);
            grow::<true, false>(&row, &around, scale, height, receiver, floor);
        } else {
            grow::<false, false>(&row, &around, scale, height, receiver, &mut []);
        }
    }
}

/// The new heights, receivers and floors of a row.
#[inline(always)]
fn grow<const FLOORS: bool, const FINEST: bool>(
    row: &Row<'_>,
    around: &Around<'_>,
    scale: Scale,
    out: &mut [f32],
    receiver: &mut [f32],
    out_floor: &mut [f32],
) {
    let n = out.len();
    let (height, area, fixed) = (&row.height[..n], &row.area[..n], &row.fixed[..n]);
    let (river, stable) = (&row.river[..n], &row.stable[..n]);
    let receiver = &mut receiver[..n];
    let (floors, banks) = (if FLOORS { n } else { 0 }, if FINEST { n } else { 0 });
    let irregular = if FINEST { 0 } else { n };
    let (width, bank) = (&row.width[..floors], &row.bank[..banks]);
    let out_floor = &mut out_floor[..floors];
    let heights = around.height.map(|row| &row[..n]);
    let distances = around.distance.map(|row| &row[..irregular]);
    let around_floor = around.floor.map(|row| &row[..floors]);
    let around_bank = around.bank.map(|row| &row[..banks]);
    for i in 0..n {
        let river_slope = river[i] * power(area[i], -CONCAVITY);
        let rise = river_slope * stable[i] / (river_slope + stable[i]) * scale.cell;
        let rise = if rise > 3.0 * MIN_RISE { rise } else { 3.0 * MIN_RISE };
        let flat = if FLOOR_SLOPE * scale.cell < rise { FLOOR_SLOPE * scale.cell } else { rise };
        let here = height[i];
        let free = fixed[i] == FREE;
        // Free nodes drain to a lower neighbour.
        let below = if free { here } else { -UNKNOWN };
        let (mut lowest, mut best, mut floor) = (UNKNOWN, -1.0f32, 0.0f32);
        for code in 0..8 {
            let there = heights[code][i];
            let distance = match (FINEST, code & 1 == 1) {
                (true, true) => SQRT_2,
                (true, false) => 1.0,
                (false, _) => distances[code][i],
            };
            let mut slope = rise;
            let mut left = 0.0;
            if FLOORS {
                left = around_floor[code][i] - distance * scale.cell;
                slope = if left > 0.0 { flat } else { rise };
            }
            let mut candidate = there + distance * slope;
            if FINEST {
                let deeper = around_bank[code][i] - bank[i];
                candidate += if deeper > 0.0 { deeper } else { 0.0 };
            }
            let possible = (there < below) | (fixed[i] == code as f32);
            let better = possible & (candidate < lowest);
            lowest = if better { candidate } else { lowest };
            best = if better { code as f32 } else { best };
            if FLOORS {
                floor = if better { left } else { floor };
            }
        }
        if FINEST {
            // The height of a front that passes between a neighbour and the lower one beside it.
            let near = if free & (area[i] < SLOPE_AREA) { rise * FRAC_1_SQRT_2 } else { 0.0 };
            for code in [0usize, 2, 4, 6] {
                for beside in [(code + 1) & 7, (code + 7) & 7] {
                    let (there, corner) = (heights[code][i], heights[beside][i]);
                    let fall = there - corner;
                    let square = rise * rise - fall * fall;
                    let candidate = there + (if square > 0.0 { square } else { 0.0 }).sqrt();
                    let better = (fall > 0.0) & (fall < near) & (corner < here) & (candidate < lowest);
                    lowest = if better { candidate } else { lowest };
                    best = if better { beside as f32 } else { best };
                    floor = if better { 0.0 } else { floor };
                }
            }
        }
        out[i] = if lowest < here { lowest } else { here };
        receiver[i] = if best >= 0.0 { best } else { receiver[i] };
        if FLOORS {
            let share = area[i] * scale.floor_area;
            let own = if share > 1.0 { FLOOR_WIDTH * share.sqrt() * width[i] } else { 0.0 };
            let own = if fixed[i] < 8.0 { own } else { 0.0 };
            out_floor[i] = if floor > own { floor } else { own };
        }
    }
}
