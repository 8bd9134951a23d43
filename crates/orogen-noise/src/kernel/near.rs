//! Scattered points in the plane that lie in few cells. The keys of these cells are looked up in a table.

#![allow(clippy::needless_range_loop)] // see kernel/mod.rs

use crate::kernel::cell::{Cell, clamp};
use crate::kernel::gradient::Gradient;
use crate::kernel::pointwise::{LowRank, Pointwise};
use crate::kernel::source::PerlinSource;
use crate::program::{Octave, Program};
use orogen_simd::{Body, Double, F32Lanes, F64Lanes, MaskLanes, Simd, U32Lanes};

/// Number of points that are examined to find their range of cells.
const AHEAD: usize = 256;
/// Minimum number of remaining points for which a table is built.
const WORTH: usize = 4 * AHEAD;
/// Number of points that are computed without a table after their range of cells was too large for one.
const PLAIN: usize = 16 * AHEAD;
/// Number of cells along an axis that a table covers.
const CELLS: usize = 16;
/// Number of registers with points outside the table after which a new table is built.
const MISSES: usize = 4;
/// Maximum number of lanes.
const LANES: usize = 32;
/// Limit of cells in tables. The program's limit is twice as far. Positions beyond it must be clamped, which tables do
/// not support.
const FARTHEST: f64 = 562_949_953_421_312.0;

/// Registers of points.
pub(crate) trait Placed<S: Simd> {
    /// The cells along an axis of the points from `start` on. There are at least as many points as lanes.
    fn wholes(&self, simd: S, axis: usize, start: usize) -> S::F64;
    /// The fractions along an axis of the points from `start` on, and the results of [`Simd::place`] for their cells.
    fn place(&self, simd: S, axis: usize, start: usize, from: f64) -> (S::F32, S::U32, S::U32);
    /// The cells along an axis of the points from `start` on, at any position.
    fn cell(&self, simd: S, axis: usize, start: usize) -> Cell<S>;
}

/// Whether [`Scattered`] supports the octave. It must be the only octave of a noise that is not a fractal, because
/// offset and amplitude are ignored.
#[inline(always)]
pub(crate) fn covers(octave: &Octave) -> bool {
    !octave.tiled && octave.amplitude == 1.0 && octave.offset[0] == 0.0 && octave.offset[1] == 0.0
}

/// Points at any position.
pub(crate) struct Scattered<'a> {
    pub frequency: f64,
    pub limit: f64,
    pub at: [&'a [f64]; 2],
}

impl Scattered<'_> {
    #[inline(always)]
    fn position<S: Simd>(&self, simd: S, axis: usize, start: usize) -> S::F64 {
        simd.load_f64_partial(self.at[axis].get(start..).unwrap_or_default(), 0.0)
    }
}

impl<S: Simd> Placed<S> for Scattered<'_> {
    #[inline(always)]
    fn wholes(&self, simd: S, axis: usize, start: usize) -> S::F64 {
        self.cell(simd, axis, start).whole
    }
    #[inline(always)]
    fn place(&self, simd: S, axis: usize, start: usize, from: f64) -> (S::F32, S::U32, S::U32) {
        let u = self.position(simd, axis, start) * simd.f64(self.frequency);
        let (whole, place, elsewhere) = simd.place(u, from, CELLS as u32);
        ((u - whole).narrow(), place, elsewhere)
    }
    #[inline(always)]
    fn cell(&self, simd: S, axis: usize, start: usize) -> Cell<S> {
        let held = clamp(simd, self.position(simd, axis, start), self.limit);
        Cell::of(simd, held * simd.f64(self.frequency))
    }
}

/// Points around an origin, with f32 coordinates.
struct Around<'a> {
    frequency: f32,
    /// The cell of the origin, and the origin's fraction in it.
    whole: [f64; 2],
    t: [f32; 2],
    at: [&'a [f32]; 2],
}

impl Around<'_> {
    /// Maximum distance from the origin's cell, in cells.
    const FARTHEST: f32 = 1_073_741_824.0;

    /// The coordinate in cells, relative to the origin's cell.
    #[inline(always)]
    fn coordinate<S: Simd>(&self, simd: S, axis: usize, start: usize) -> S::F32 {
        let position = simd.load_partial(self.at[axis].get(start..).unwrap_or_default(), 0.0);
        position.mul_add(simd.f32(self.frequency), simd.f32(self.t[axis]))
    }
}

impl<S: Simd> Placed<S> for Around<'_> {
    #[inline(always)]
    fn wholes(&self, simd: S, axis: usize, start: usize) -> S::F64 {
        self.cell(simd, axis, start).whole
    }
    #[inline(always)]
    fn place(&self, simd: S, axis: usize, start: usize, from: f64) -> (S::F32, S::U32, S::U32) {
        let u = self.coordinate(simd, axis, start);
        let whole = u.floor();
        // Tables lie near the points, so the difference fits into an i32.
        let first = (from - self.whole[axis]) as i32;
        let place = whole.to_i32() - simd.u32(first as u32);
        (u - whole, place, place & simd.u32(!(CELLS as u32 - 1)))
    }
    #[inline(always)]
    fn cell(&self, simd: S, axis: usize, start: usize) -> Cell<S> {
        let u = self.coordinate(simd, axis, start);
        let held = u.max(simd.f32(-Around::FARTHEST)).min(simd.f32(Around::FARTHEST));
        let whole = held.floor();
        let mut cell = Cell::at(simd, simd.f64(self.whole[axis]) + whole.widen());
        cell.t = held - whole;
        cell
    }
}

/// Fills with a noise that is [`Pointwise::KEYED`].
#[inline(always)]
pub(crate) fn fill<S: Simd, P: Pointwise<S>, A: Placed<S>>(simd: S, noise: P, points: &A, target: &mut [f32]) {
    let mut start = 0;
    while start < target.len() {
        if target.len() - start >= WORTH
            && let Some(near) = Near::of(simd, noise, points, start)
        {
            start = near.fill(simd, noise, points, target, start);
            continue;
        }
        let end = target.len().min(start + PLAIN);
        while start < end {
            anywhere(simd, noise, points, target, start);
            start += S::LANES;
        }
    }
}

/// Fills a register of points at any position.
#[inline(always)]
fn anywhere<S: Simd, P: Pointwise<S>, A: Placed<S>>(simd: S, noise: P, points: &A, target: &mut [f32], start: usize) {
    let (x, y) = (points.cell(simd, 0, start), points.cell(simd, 1, start));
    let mut sum = [simd.f32(0.0); 5];
    noise.add_keyed(simd, [x.t, y.t], [noise.keys(simd, 0, &x), noise.keys(simd, 1, &y)], &mut sum);
    sum[0].store_partial(&mut target[start..]);
}

/// The keys of neighboring cells in the plane.
struct Near<S: Simd> {
    /// The first cell's number, per axis.
    first: [f64; 2],
    /// The keys of the cells and of their successors, per axis.
    keys: [[S::Table16; 2]; 2],
}

impl<S: Simd> Near<S> {
    /// The keys around the points from `start` on, which are at least [`AHEAD`]; `None` if they lie in too many cells.
    #[inline(always)]
    fn of<P: Pointwise<S>, A: Placed<S>>(simd: S, noise: P, points: &A, start: usize) -> Option<Near<S>> {
        let mut near = Near { first: [0.0; 2], keys: [[simd.table16(&[0.0; 16]); 2]; 2] };
        for axis in 0..2 {
            let mut least = points.wholes(simd, axis, start);
            let mut most = least;
            for p in (S::LANES..AHEAD).step_by(S::LANES) {
                let whole = points.wholes(simd, axis, start + p);
                (least, most) = (least.min(whole), most.max(whole));
            }
            let (mut low, mut high) = ([0.0; LANES], [0.0; LANES]);
            least.store(&mut low);
            most.store(&mut high);
            let (mut from, mut to) = (low[0], high[0]);
            for lane in 1..S::LANES {
                (from, to) = (from.min(low[lane]), to.max(high[lane]));
            }
            let spare = (CELLS - 1) as f64 - (to - from);
            if !(spare >= 0.0 && from.abs() < FARTHEST) {
                return None;
            }
            from -= (spare * 0.5).floor();
            near.first[axis] = from;
            let (mut numbers, mut made) = ([0.0; LANES], [0.0; LANES]);
            for number in 0..LANES {
                numbers[number] = from + number as f64;
            }
            for p in (0..LANES).step_by(S::LANES) {
                let cell = Cell::at(simd, simd.load_f64(&numbers[p..]));
                noise.keys(simd, axis, &cell)[0].as_f32().store(&mut made[p..]);
            }
            for next in 0..2 {
                let mut table = [0.0; CELLS];
                table.copy_from_slice(&made[next..next + CELLS]);
                near.keys[axis][next] = simd.table16(&table);
            }
        }
        Some(near)
    }

    /// Fills from `start` on while most points are inside the table; returns the index at which it stopped.
    #[inline(always)]
    fn fill<P: Pointwise<S>, A: Placed<S>>(
        &self,
        simd: S,
        noise: P,
        points: &A,
        target: &mut [f32],
        mut start: usize,
    ) -> usize {
        let mut misses = 0;
        while start < target.len() && misses < MISSES {
            let mut outside = simd.u32(0);
            let (mut t, mut keys) = ([simd.f32(0.0); 2], [[simd.u32(0); 2]; 2]);
            for axis in 0..2 {
                let (fraction, place, elsewhere) = points.place(simd, axis, start, self.first[axis]);
                t[axis] = fraction;
                outside = outside | elsewhere;
                for next in 0..2 {
                    keys[axis][next] = simd.lookup16(self.keys[axis][next], place).bits();
                }
            }
            if (!outside.eq(simd.u32(0))).any() {
                misses += 1;
                anywhere(simd, noise, points, target, start);
            } else {
                let mut sum = [simd.f32(0.0); 5];
                noise.add_keyed(simd, t, keys, &mut sum);
                sum[0].store_partial(&mut target[start..]);
            }
            start += S::LANES;
        }
        start
    }
}

/// Fills points around an origin with Perlin noise.
pub(crate) struct FillAround<'a> {
    pub program: &'a Program,
    pub origin: [f64; 2],
    /// x and y of the points relative to the origin, in metres; both as long as the results.
    pub at: [&'a [f32]; 2],
    pub value: &'a mut [f32],
}

impl Body for FillAround<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        if const { S::LANES > 4 } { Double(simd).run(Abreast(self)) } else { simd.run(Abreast(self)) }
    }
}

/// The same body with the fastest number of registers per step.
struct Abreast<'a>(FillAround<'a>);

impl Body for Abreast<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let FillAround { program, origin, at, value } = self.0;
        let [octave] = program.octaves() else { return };
        let (mut whole, mut t) = ([0.0; 2], [0.0; 2]);
        for axis in 0..2 {
            let held = clamp(simd, simd.f64(origin[axis]), program.limit);
            let cell = Cell::<S>::of(simd, held * simd.f64(octave.frequency));
            let (mut wholes, mut ts) = ([0.0; LANES], [0.0; LANES]);
            cell.whole.store(&mut wholes);
            cell.t.store(&mut ts);
            (whole[axis], t[axis]) = (wholes[0], ts[0]);
        }
        let noise = LowRank::<Gradient<PerlinSource<S>, 2>>::new(simd, program.source, octave);
        fill(simd, noise, &Around { frequency: octave.frequency as f32, whole, t, at }, value);
    }
}
