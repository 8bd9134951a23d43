//! Lattices of samples of noise on corners of simplices: sums of octaves, row by row.
//!
//! Along a row the cubes that samples are in follow each other, so that their keys can be kept in a table and picked by permutes, as
//! lattice lines are for the low-rank bases. Everything else is small fractions: see [`crate::kernel::simplex`].

#![allow(clippy::needless_range_loop)] // see kernel/mod.rs

use crate::kernel::cell::{Cell, clamp, coordinate};
use crate::kernel::families::with_family;
use crate::kernel::outputs::Outputs;
use crate::kernel::pointwise::Pointwise;
use crate::kernel::scattered::Call;
use crate::kernel::simplex::{Corners, Simplices, Slanted, beyond_x, scaled, slanted, wrapped};
use crate::kernel::source::Lattice;
use crate::program::{Octave, Program};
use orogen_simd::{Body, F32Lanes, F64Lanes, MaskLanes, Simd, U32Lanes};
use std::marker::PhantomData;

/// Columns worked on at a time.
const WIDTH: usize = 256;
/// Cubes a strip may span and still have their keys kept.
const SPAN: usize = WIDTH + 48;
/// The most lanes of any level.
const MAX_LANES: usize = 16;

/// One octave over a strip of columns.
#[repr(C, align(64))]
struct Strip {
    /// Fractions of the columns, and of their skew.
    t: [f32; WIDTH],
    rest: [f32; WIDTH],
    /// Cubes along x, and along all other axes: whole numbers counted from their register's first,
    index: [[u32; WIDTH]; 2],
    /// and each register's first, counted from the strip's first,
    first: [[u32; WIDTH / 4]; 2],
    /// which is this.
    origin: [f64; 2],
    /// How many keys there are.
    span: [usize; 2],
    /// Keys along each axis from a number on, and that number.
    keys: [[u32; SPAN]; 4],
    held: [Option<f64>; 4],
    /// Whether cubes follow so closely that those of a register fit one.
    dense: bool,
}

impl Strip {
    const fn new() -> Strip {
        Strip {
            t: [0.0; WIDTH],
            rest: [0.0; WIDTH],
            index: [[0; WIDTH]; 2],
            first: [[0; WIDTH / 4]; 2],
            origin: [0.0; 2],
            span: [0; 2],
            keys: [[0; SPAN]; 4],
            held: [None; 4],
            dense: false,
        }
    }
}

/// Fills a lattice with a plain sum of octaves; `depths` are z and w of the slice.
#[inline(always)]
pub(crate) fn fill<S: Simd, C: Corners, const DIMS: usize>(
    simd: S,
    program: &Program,
    (xs, ys): (&[f64], &[f64]),
    depths: [f64; 2],
    outputs: &mut Outputs,
) {
    let octaves = program.octaves();
    let mut strips: Vec<Strip> = Vec::new();
    strips.resize_with(octaves.len(), Strip::new);
    for (s, columns) in xs.chunks(WIDTH).enumerate() {
        let mut dense = true;
        for (strip, octave) in strips.iter_mut().zip(octaves) {
            simd.run(Columns::<DIMS> { octave, limit: program.limit, strip, xs: columns });
            dense &= strip.dense;
        }
        for (r, y) in ys.iter().enumerate() {
            let start = r * xs.len() + s * WIDTH;
            let target = outputs.part(start, columns.len());
            if dense {
                let at = [0.0, *y, depths[0], depths[1]];
                simd.run(Row::<C, DIMS> { program, strips: &mut strips, at, to: target.value, corners: PhantomData });
            } else {
                let (rows, z, w) = ([*y; WIDTH], [depths[0]; WIDTH], [depths[1]; WIDTH]);
                let count = columns.len();
                let at = [columns, &rows[..count], &z[..count], &w[..count]];
                with_family::<_, DIMS>(program.source, Call::<S, DIMS> { simd, program, at, target });
            }
        }
    }
}

/// Prepares the columns of a strip.
struct Columns<'a, const DIMS: usize> {
    octave: &'a Octave,
    limit: f64,
    strip: &'a mut Strip,
    xs: &'a [f64],
}

impl<const DIMS: usize> Body for Columns<'_, DIMS> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Columns { octave, limit, strip, xs } = self;
        strip.held = [None; 4];
        let Some(&last) = xs.last() else { return };
        let mut lanes = [0.0; MAX_LANES];
        let (mut reach, mut farthest) = ([simd.u32(0); 2], [0; 2]);
        for v in 0..xs.len().div_ceil(S::LANES).min(WIDTH / S::LANES) {
            let at = v * S::LANES;
            let held = clamp(simd, simd.load_f64_partial(&xs[at..], last), limit);
            let here = slanted::<S, DIMS>(simd, coordinate(simd, octave, 0, held));
            here.t.store(&mut strip.t[at..]);
            here.rest.store(&mut strip.rest[at..]);
            for (which, whole) in [here.whole + here.skew, here.skew].into_iter().enumerate() {
                if v == 0 {
                    whole.store(&mut lanes);
                    strip.origin[which] = lanes[0];
                }
                // Exact while small; what is not (or lies before the first) turns into a huge number and fails the test below.
                let place = (whole - simd.f64(strip.origin[which])).narrow().to_i32();
                let mut places = [0; MAX_LANES];
                place.store(&mut places);
                let index = place - simd.u32(places[0]);
                index.store(&mut strip.index[which][at..]);
                strip.first[which][v] = places[0];
                // Fractions that add up to more than one step on by up to two.
                reach[which] = reach[which] | index | (index + simd.u32(2));
                farthest[which] = farthest[which].max(places[0]);
            }
        }
        strip.dense = true;
        for which in 0..2 {
            let spread = !reach[which].shr(S::LANES.trailing_zeros()).eq(simd.u32(0));
            strip.dense &= !spread.any() && (farthest[which] as usize) < SPAN - 2 * S::LANES - 1;
            strip.span[which] = (farthest[which] as usize + S::LANES + 1).next_multiple_of(S::LANES).min(SPAN);
        }
    }
}

/// One row of samples within a strip.
struct Row<'a, C, const DIMS: usize> {
    program: &'a Program,
    strips: &'a mut [Strip],
    /// y, z and w of the row, metres, in places 1 to 3.
    at: [f64; 4],
    to: &'a mut [f32],
    corners: PhantomData<C>,
}

impl<C: Corners, const DIMS: usize> Body for Row<'_, C, DIMS> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Row { program, strips, at, to, .. } = self;
        let octaves = program.octaves();
        for o in 0..octaves.len().min(strips.len()) {
            let (octave, strip) = (&octaves[o], &mut strips[o]);
            let noise = Simplices::<S, C, DIMS>::new(simd, program.source, octave);
            let mut row = [slanted::<S, DIMS>(simd, simd.f64(0.0)); 4];
            for axis in 1..DIMS {
                let held = clamp(simd, simd.f64(at[axis]), program.limit);
                row[axis] = slanted::<S, DIMS>(simd, coordinate(simd, octave, axis, held));
            }
            let (rest, skew) = beyond_x::<S, DIMS>(&row);
            hold::<S, C, DIMS>(simd, noise, strip, &row, skew);
            let mut start = 0;
            while start < to.len().min(WIDTH) {
                let (place, keys) = look_up::<S, DIMS>(simd, strip, start, &row, rest);
                let raw = noise.raw::<false>(simd, &place, &keys);
                let mut sum = [simd.f32(0.0); 5];
                if o > 0 {
                    sum[0] = simd.load_partial(&to[start..], 0.0);
                }
                scaled::<S, DIMS, false>(simd, octave, C::SCALE[DIMS - 2], &raw, &mut sum);
                sum[0].store_partial(&mut to[start..]);
                start += S::LANES;
            }
        }
        if octaves.is_empty() {
            to.fill(0.0);
        }
    }
}

/// Makes the keys of the cubes along the row, where they are not those of the row before.
#[inline(always)]
fn hold<S: Simd, C: Corners, const DIMS: usize>(
    simd: S,
    noise: Simplices<S, C, DIMS>,
    strip: &mut Strip,
    row: &[Slanted<S>; 4],
    skew: S::F64,
) {
    const COUNT: [f64; MAX_LANES] =
        [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0, 13.0, 14.0, 15.0];
    for axis in 0..DIMS {
        let which = usize::from(axis > 0);
        let mut number = skew + simd.f64(strip.origin[which]);
        if axis > 0 {
            number = number + row[axis].whole;
        }
        let mut lanes = [0.0; MAX_LANES];
        number.store(&mut lanes);
        if strip.held[axis] == Some(lanes[0]) {
            continue;
        }
        strip.held[axis] = Some(lanes[0]);
        for p in (0..strip.span[which].min(SPAN)).step_by(S::LANES) {
            let cell = Cell::at(simd, number + simd.f64(p as f64) + simd.load_f64(&COUNT));
            noise.0.keys(simd, axis, &cell)[0].store(&mut strip.keys[axis][p..]);
        }
    }
}

/// The fractions of a register of samples and the keys of their cubes: what [`crate::kernel::simplex::place`] makes, by the same steps.
#[inline(always)]
fn look_up<S: Simd, const DIMS: usize>(
    simd: S,
    strip: &Strip,
    start: usize,
    row: &[Slanted<S>; 4],
    rest: S::F32,
) -> ([S::F32; 4], [[S::U32; 2]; 4]) {
    let (v, none) = (start / S::LANES, simd.f32(0.0));
    let (shared, rest) = wrapped(simd, simd.load(&strip.rest[start..]) + rest);
    let (mut t, mut keys) = ([none; 4], [[simd.u32(0); 2]; 4]);
    for axis in 0..DIMS {
        let which = usize::from(axis > 0);
        let own = if axis == 0 { simd.load(&strip.t[start..]) } else { row[axis].t };
        let (carry, left) = wrapped(simd, own + rest);
        t[axis] = left;
        let index = simd.load_u32(&strip.index[which][start..]) + (shared + carry).to_i32();
        let first = (strip.first[which][v] as usize).min(SPAN - 1 - S::LANES);
        let table = &strip.keys[axis];
        keys[axis] = [simd.load_u32(&table[first..]).permute(index), simd.load_u32(&table[first + 1..]).permute(index)];
    }
    (t, keys)
}
