//! Simplex noise on lattices of samples: sums of octaves, computed row by row.
//!
//! Along a row the cubes of successive samples are neighbors, so their keys are stored in a table and selected with
//! permutes, like lattice lines of the low-rank bases. If cubes are wide, most registers of samples lie in one line of
//! cubes along x. In this case the gradients of the lattice lines at the edges of these cubes are stored instead. The
//! remaining arithmetic uses small fractions (see [`crate::kernel::simplex`]).

#![allow(clippy::needless_range_loop)] // see kernel/mod.rs

use crate::kernel::blocks::Blocks;
use crate::kernel::cell::{Cell, clamp, coordinate};
use crate::kernel::outputs::Outputs;
use crate::kernel::simplex::{CornerGradients, Corners, Simplices, Slanted, beyond_x, raw, slanted};
use crate::kernel::source::{Gradients, Lattice};
use crate::points::{Depth, Points};
use crate::program::{Octave, Program, Source};
use orogen_simd::{Body, F32Lanes, F64Lanes, MaskLanes, Simd, U32Lanes};
use std::marker::PhantomData;

/// Columns per strip.
const WIDTH: usize = 256;
/// Maximum number of cubes of a strip whose keys are stored.
const SPAN: usize = WIDTH + 48;
/// Maximum number of lanes.
const MAX_LANES: usize = 16;

/// Maximum number of cubes of a strip along x for which the gradients of lattice lines are stored.
const LINE: usize = 64;
/// Minimum number of rows for which this is faster.
const ROWS: usize = 16;
/// Number of lattice lines that are stored. The lines at the edges of one line of cubes have different slots.
const LINES: usize = 16;

/// The gradients of the points of a lattice line along x.
#[repr(C, align(64))]
#[derive(Clone, Copy)]
struct Line {
    gradients: [[f32; LINE]; 3],
    /// The cell numbers of the first point.
    of: [f64; 3],
}

/// One octave over a strip of columns.
#[repr(C, align(64))]
struct Strip {
    /// Fractions of the columns, and of their skew.
    t: [f32; WIDTH],
    rest: [f32; WIDTH],
    /// Cubes along x, and along all other axes, relative to the first of their register.
    index: [[u32; WIDTH]; 2],
    /// The first cube of each register, relative to the first of the strip.
    first: [[u32; WIDTH / 4]; 2],
    /// The first cube of the strip.
    origin: [f64; 2],
    /// Number of keys.
    span: [usize; 2],
    /// Keys along each axis, and the cell number of the first key.
    keys: [[u32; SPAN]; 4],
    held: [Option<f64>; 4],
    /// Whether the cubes of a register fit into one register of keys.
    dense: bool,
    /// Whether registers lie in one line of cubes often enough to store lattice lines.
    wide: bool,
    /// If wide, the lanes of each register whose number along the other axes is one more than that of the first lane.
    steps: [u32; WIDTH / 4],
    /// Lattice lines; the number of a line selects its slot.
    lines: Vec<Line>,
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
            wide: false,
            steps: [0; WIDTH / 4],
            lines: Vec::new(),
        }
    }
}

/// Fills a lattice with a plain sum of octaves. `depths` are z and w of the slice.
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
            simd.run(Columns::<DIMS> { octave, limit: program.limit, strip, xs: columns, rows: ys.len() });
            dense &= strip.dense;
        }
        for (r, y) in ys.iter().enumerate() {
            let start = r * xs.len() + s * WIDTH;
            let target = outputs.part(start, columns.len());
            if dense {
                let at = [0.0, *y, depths[0], depths[1]];
                simd.run(Row::<C, DIMS> { program, strips: &mut strips, at, to: target.value, corners: PhantomData });
            } else {
                let points = Points::Lattice { xs: columns, ys: std::slice::from_ref(y) };
                let depths = &depths.map(Depth::Slice)[..DIMS - 2];
                simd.run(Blocks::<DIMS> { program, points, depths, outputs: target });
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
    /// Number of rows.
    rows: usize,
}

impl<const DIMS: usize> Body for Columns<'_, DIMS> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Columns { octave, limit, strip, xs, rows } = self;
        strip.held = [None; 4];
        let Some(&last) = xs.last() else { return };
        let mut lanes = [0.0; MAX_LANES];
        let (mut reach, mut farthest) = ([simd.u32(0); 2], [0; 2]);
        let mut most = simd.u32(0);
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
                // Small numbers are exact. Large numbers, and cells before the first, become huge and fail the test
                // below.
                let place = (whole - simd.f64(strip.origin[which])).narrow().to_i32();
                let mut places = [0; MAX_LANES];
                place.store(&mut places);
                let index = place - simd.u32(places[0]);
                index.store(&mut strip.index[which][at..]);
                strip.first[which][v] = places[0];
                // If the fractions sum to more than one, the cube advances by up to two.
                reach[which] = reach[which] | index | (index + simd.u32(2));
                farthest[which] = farthest[which].max(places[0]);
                if which == 1 {
                    strip.steps[v] = index.eq(simd.u32(1)).to_bits();
                    most = most | index;
                }
            }
        }
        strip.dense = true;
        for which in 0..2 {
            let spread = !reach[which].shr(S::LANES.trailing_zeros()).eq(simd.u32(0));
            strip.dense &= !spread.any() && (farthest[which] as usize) < SPAN - 2 * S::LANES - 1;
            strip.span[which] = (farthest[which] as usize + S::LANES + 1).next_multiple_of(S::LANES).min(SPAN);
        }
        // If a register advances twice along the other axes, hardly any register lies in one line of cubes.
        let narrow = !most.shr(1).eq(simd.u32(0));
        strip.wide = strip.dense && DIMS < 4 && rows >= ROWS && !narrow.any() && strip.span[0] <= LINE;
        if strip.wide && strip.lines.is_empty() {
            strip.lines = vec![Line { gradients: [[0.0; LINE]; 3], of: [f64::NAN; 3] }; LINES];
        }
    }
}

/// One row of samples within a strip.
struct Row<'a, C, const DIMS: usize> {
    program: &'a Program,
    strips: &'a mut [Strip],
    /// y, z and w of the row in metres, at indices 1 to 3.
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
            let noise = Simplices::<S, C, DIMS>(C::Lattice::<S>::new(simd, program.source, octave).folded());
            let mut row = [slanted::<S, DIMS>(simd, simd.f64(0.0)); 4];
            for axis in 1..DIMS {
                let held = clamp(simd, simd.f64(at[axis]), program.limit);
                row[axis] = slanted::<S, DIMS>(simd, coordinate(simd, octave, axis, held));
            }
            let (rest, skew) = beyond_x::<S, DIMS>(&row);
            hold::<S, C, DIMS>(simd, noise, strip, &row, skew);
            let mut held = Edges::NONE;
            let factor = simd.f32(octave.amplitude * C::SCALE[DIMS - 2]);
            let mut start = 0;
            while start < to.len().min(WIDTH) {
                let place = look_up::<S, DIMS>(simd, strip, start, &row, rest);
                let line = if DIMS < 4 && strip.wide { place.line::<DIMS>(strip, start) } else { None };
                let raw = match line {
                    Some(line) => {
                        if held.y != line[0] || held.z != line[1] {
                            held = Edges::of::<S, C, DIMS>(simd, (program.source, octave), strip, line);
                        }
                        let lines = held.lines(&strip.lines);
                        let first = (strip.first[0][start / S::LANES] as usize).min(LINE - 1 - S::LANES);
                        let index = place.index(simd, strip, start, 0);
                        raw::<S, _, DIMS, false>(simd, &place.t, &LineCorners::<S, DIMS> { lines, first, index })
                    }
                    None => noise.raw::<false>(simd, &place.t, &place.keys::<DIMS>(simd, strip, start)),
                };
                let before = if o > 0 { simd.load_partial(&to[start..], 0.0) } else { simd.f32(0.0) };
                // The same operations as [`crate::kernel::simplex::scaled`].
                factor.mul_add(raw[0], before).store_partial(&mut to[start..]);
                start += S::LANES;
            }
        }
        if octaves.is_empty() {
            to.fill(0.0);
        }
    }
}

/// Computes the keys of the cubes along the row, unless they are the same as in the previous row.
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

/// A register of samples in the skewed lattice.
struct SkewedPoints<S: Simd> {
    /// Fractions.
    t: [S::F32; 4],
    /// Lanes in which the fractions of the skew sum to a step along all axes.
    shared: S::Mask,
    /// Lanes in which an axis makes an additional step.
    carry: [S::Mask; 4],
}

/// The fractions of a register of samples: the result of [`crate::kernel::simplex::place`], computed with the same
/// steps.
#[inline(always)]
fn look_up<S: Simd, const DIMS: usize>(
    simd: S,
    strip: &Strip,
    start: usize,
    row: &[Slanted<S>; 4],
    rest: S::F32,
) -> SkewedPoints<S> {
    let (rest, shared) = stepped(simd, simd.load(&strip.rest[start..]) + rest);
    let mut place = SkewedPoints { t: [rest; 4], shared, carry: [shared; 4] };
    for axis in 0..DIMS {
        let own = if axis == 0 { simd.load(&strip.t[start..]) } else { row[axis].t };
        (place.t[axis], place.carry[axis]) = stepped(simd, own + rest);
    }
    place
}

/// Splits a number from 0 to 2 into a fraction and a mask of the lanes in which the number is at least 1.
#[inline(always)]
fn stepped<S: Simd>(simd: S, t: S::F32) -> (S::F32, S::Mask) {
    let one = simd.f32(1.0);
    let reached = one.le(t);
    (t - one.select(reached, simd.f32(0.0)), reached)
}

impl<S: Simd> SkewedPoints<S> {
    /// The cubes along an axis, relative to the first cube of the register, as indices for a permute.
    #[inline(always)]
    fn index(&self, simd: S, strip: &Strip, start: usize, axis: usize) -> S::U32 {
        // A permute interprets this value as 1. It compiles to one masked addition; adding 1 would take two
        // instructions.
        let (zero, one) = (simd.u32(0), simd.u32(1 + 2 * MAX_LANES as u32));
        let index = simd.load_u32(&strip.index[usize::from(axis > 0)][start..]);
        index + one.select(self.shared, zero) + one.select(self.carry[axis], zero)
    }

    /// The keys of the cubes and of the next cubes.
    #[inline(always)]
    fn keys<const DIMS: usize>(&self, simd: S, strip: &Strip, start: usize) -> [[S::U32; 2]; 4] {
        let mut keys = [[simd.u32(0); 2]; 4];
        for axis in 0..DIMS {
            let index = self.index(simd, strip, start, axis);
            let first = (strip.first[usize::from(axis > 0)][start / S::LANES] as usize).min(SPAN - 1 - S::LANES);
            let table = &strip.keys[axis];
            keys[axis] =
                [simd.load_u32(&table[first..]).permute(index), simd.load_u32(&table[first + 1..]).permute(index)];
        }
        keys
    }

    /// The line of cubes along x that contains all samples, if there is one, as its numbers along y and z, relative to
    /// the first key.
    #[inline(always)]
    fn line<const DIMS: usize>(&self, strip: &Strip, start: usize) -> Option<[usize; 2]> {
        let v = start / S::LANES;
        let (steps, shared) = (strip.steps[v], self.shared.to_bits());
        let (mut line, mut apart) = ([strip.first[1][v] as usize; 2], 0);
        for axis in 1..DIMS.min(3) {
            // The sum of three bits per lane, as two binary digits.
            let carry = self.carry[axis].to_bits();
            let (ones, twos) = (steps ^ shared ^ carry, (steps & shared) | (carry & (steps | shared)));
            apart |= (ones ^ 0_u32.wrapping_sub(ones & 1)) | (twos ^ 0_u32.wrapping_sub(twos & 1));
            line[axis - 1] += ((ones & 1) + 2 * (twos & 1)) as usize;
        }
        let lanes = u32::MAX >> (32 - S::LANES);
        (apart & lanes == 0).then_some(line)
    }
}

/// The lattice lines at the edges of a line of cubes.
#[derive(Clone, Copy)]
struct Edges {
    /// The numbers of the line of cubes along y and z, relative to the first key.
    y: usize,
    z: usize,
    /// The slots of the lattice lines: those at y and y + 1, then the same at z + 1.
    slots: [usize; 4],
}

impl Edges {
    const NONE: Edges = Edges { y: usize::MAX, z: usize::MAX, slots: [0; 4] };

    /// Computes the missing lines.
    #[inline(always)]
    fn of<S: Simd, C: Corners, const DIMS: usize>(
        simd: S,
        (source, octave): (Source, &Octave),
        strip: &mut Strip,
        line: [usize; 2],
    ) -> Edges {
        let mut slots = [0; 4];
        for edge in 0..if DIMS == 2 { 2 } else { 4 } {
            let at = [(line[0] + (edge & 1)).min(SPAN - 1), (line[1] + (edge >> 1)).min(SPAN - 1)];
            let mut of = [0.0; 3];
            for axis in 0..DIMS.min(3) {
                of[axis] = strip.held[axis].unwrap_or_default() + if axis > 0 { at[axis - 1] as f64 } else { 0.0 };
            }
            let slot = if DIMS == 2 { at[0] & 15 } else { (at[0] & 3) + 4 * (at[1] & 3) };
            slots[edge] = slot;
            let there = strip.lines[slot].of;
            if there[0] != of[0] || there[1] != of[1] || there[2] != of[2] {
                simd.run(Make::<C, DIMS> { source, octave, strip, at, slot, of, corners: PhantomData });
            }
        }
        Edges { y: line[0], z: line[1], slots }
    }

    #[inline(always)]
    fn lines<'a>(&self, lines: &'a [Line]) -> [&'a [[f32; LINE]; 3]; 4] {
        let [a, b, c, d] = self.slots;
        [&lines[a].gradients, &lines[b].gradients, &lines[c].gradients, &lines[d].gradients]
    }
}

/// Computes the gradients of a lattice line.
struct Make<'a, C, const DIMS: usize> {
    source: Source,
    octave: &'a Octave,
    strip: &'a mut Strip,
    /// The index of the line among the keys along y and z.
    at: [usize; 2],
    slot: usize,
    of: [f64; 3],
    corners: PhantomData<C>,
}

impl<C: Corners, const DIMS: usize> Body for Make<'_, C, DIMS> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Make { source, octave, strip, at, slot, of, .. } = self;
        let lattice = C::Lattice::<S>::new(simd, source, octave).folded();
        let line = &mut strip.lines[slot];
        line.of = of;
        let (y, z) = (simd.u32(strip.keys[1][at[0]]), simd.u32(strip.keys[2][at[1]]));
        for p in (0..strip.span[0].min(LINE)).step_by(S::LANES) {
            let x = simd.load_u32(&strip.keys[0][p..]);
            let gradient = lattice.gradient::<DIMS>(simd, lattice.hash::<DIMS>(simd, [x, y, z, z]));
            for axis in 0..DIMS.min(3) {
                gradient[axis].store(&mut line.gradients[axis][p..]);
            }
        }
    }
}

/// Gradients that are stored for lattice lines.
struct LineCorners<'a, S: Simd, const DIMS: usize> {
    /// See [`Edges`].
    lines: [&'a [[f32; LINE]; 3]; 4],
    /// The first point of the register.
    first: usize,
    /// The points of the samples, relative to the first.
    index: S::U32,
}

impl<S: Simd, const DIMS: usize> LineCorners<'_, S, DIMS> {
    /// The gradient of the corner at an offset along each axis.
    #[inline(always)]
    fn on(&self, simd: S, [x, y, z]: [usize; 3]) -> [S::F32; 4] {
        let line = self.lines[y + 2 * z];
        let mut gradient = [simd.f32(0.0); 4];
        for axis in 0..DIMS.min(3) {
            gradient[axis] = simd.load(&line[axis][self.first + x..]).permute(self.index);
        }
        gradient
    }

    /// `one` where the mask is set, otherwise `other`.
    #[inline(always)]
    fn either(mask: S::Mask, mut one: [S::F32; 4], other: [S::F32; 4]) -> [S::F32; 4] {
        for axis in 0..DIMS.min(3) {
            one[axis] = one[axis].select(mask, other[axis]);
        }
        one
    }
}

impl<S: Simd, const DIMS: usize> CornerGradients<S> for LineCorners<'_, S, DIMS> {
    #[inline(always)]
    fn gradient(&self, simd: S, number: usize, waits: &[S::Mask; 4]) -> [S::F32; 4] {
        match (DIMS, number) {
            (_, 0) => self.on(simd, [0, 0, 0]),
            (2, 1) => Self::either(waits[0], self.on(simd, [0, 1, 0]), self.on(simd, [1, 0, 0])),
            (2, _) => self.on(simd, [1, 1, 0]),
            (_, 1) => {
                let beyond = Self::either(waits[1], self.on(simd, [0, 0, 1]), self.on(simd, [0, 1, 0]));
                Self::either(waits[0], beyond, self.on(simd, [1, 0, 0]))
            }
            (_, 2) => {
                let along = Self::either(waits[1], self.on(simd, [1, 0, 1]), self.on(simd, [1, 1, 0]));
                Self::either(waits[0], self.on(simd, [0, 1, 1]), along)
            }
            _ => self.on(simd, [1, 1, 1]),
        }
    }
}
