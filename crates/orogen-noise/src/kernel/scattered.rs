//! Points anywhere: block by block, octave by octave.

#![allow(clippy::needless_range_loop)] // see kernel/mod.rs

use crate::kernel::basis::{Basis, Coefficients, Rows, Visit, Weights, with_basis};
use crate::kernel::cell::{Cell, clamp};
use crate::kernel::combine::{Sample, add_size, add_weighted, finish_sizes};
use crate::program::{Combine, Octave, Program, Source};
use orogen_simd::{Body, F32Lanes, F64Lanes, Simd};

/// How many points are worked on at a time: their positions and sums stay in the first-level cache.
pub(crate) const BLOCK: usize = 128;

/// Positions of a block, metres, clamped. Places beyond the points repeat the last one.
#[repr(C, align(64))]
pub(crate) struct Block {
    pub x: [f64; BLOCK],
    pub y: [f64; BLOCK],
    pub z: [f64; BLOCK],
}

impl Block {
    pub(crate) const fn new() -> Block {
        Block { x: [0.0; BLOCK], y: [0.0; BLOCK], z: [0.0; BLOCK] }
    }

    /// Holds the first `count` positions within the limit and fills up to whole registers.
    #[inline(always)]
    pub(crate) fn settle<S: Simd>(&mut self, simd: S, count: usize, limit: f64, deep: bool) {
        for axis in [&mut self.x, &mut self.y, &mut self.z].into_iter().take(if deep { 3 } else { 2 }) {
            let last = axis[count.saturating_sub(1).min(BLOCK - 1)];
            axis[count.min(BLOCK)..].fill(last);
            for lanes in axis.chunks_exact_mut(S::LANES) {
                clamp(simd, simd.load_f64(lanes), limit).store(lanes);
            }
        }
    }

    /// The same with x and y read from where they are.
    #[inline(always)]
    pub(crate) fn settle_from<S: Simd>(&mut self, simd: S, [x, y]: [&[f64]; 2], limit: f64) {
        for (axis, from) in [(&mut self.x, x), (&mut self.y, y)] {
            for (lanes, from) in axis.chunks_exact_mut(S::LANES).zip(from.chunks(S::LANES)) {
                clamp(simd, simd.load_f64_partial(from, 0.0), limit).store(lanes);
            }
        }
    }
}

/// Sums of a block: values and slopes along x, y and z.
#[repr(align(64))]
pub(crate) struct Sums(pub [[f32; BLOCK]; 4]);

impl Sums {
    pub(crate) const fn new() -> Sums {
        Sums([[0.0; BLOCK]; 4])
    }

    #[inline(always)]
    fn load<S: Simd>(&self, simd: S, at: usize, places: usize) -> Sample<S> {
        let mut sample = [simd.f32(0.0); 4];
        for place in 0..places {
            sample[place] = simd.load(&self.0[place][at..]);
        }
        sample
    }

    #[inline(always)]
    fn store<S: Simd>(&mut self, sample: &Sample<S>, at: usize, places: usize) {
        for place in 0..places {
            sample[place].store(&mut self.0[place][at..]);
        }
    }
}

/// Evaluates the program at the first `count` positions of the block, which must be settled. Slopes are made with `slopes`.
#[inline(always)]
pub(crate) fn evaluate<S: Simd, const DEEP: bool>(
    simd: S,
    program: &Program,
    block: &Block,
    count: usize,
    slopes: bool,
    sums: &mut Sums,
) {
    let (axes, count) = (if DEEP { 3 } else { 2 }, count.min(BLOCK));
    sums.0.iter_mut().take(if slopes { 4 } else { 1 }).for_each(|values| values.fill(0.0));
    match program.combine {
        Combine::Sum => {
            for octave in program.octaves() {
                add_octave::<S, DEEP>(simd, program.source, octave, block, count, slopes, sums);
            }
        }
        Combine::Sizes { sign } => {
            for octave in program.octaves() {
                let mut one = Sums::new();
                add_octave::<S, DEEP>(simd, program.source, octave, block, count, slopes, &mut one);
                let axes = if slopes { axes } else { 0 };
                for at in (0..count).step_by(S::LANES) {
                    let mut sum = sums.load(simd, at, axes + 1);
                    add_size(simd, &mut sum, &one.load(simd, at, axes + 1), axes);
                    sums.store::<S>(&sum, at, axes + 1);
                }
            }
            let axes = if slopes { axes } else { 0 };
            for at in (0..count).step_by(S::LANES) {
                let mut sum = sums.load(simd, at, axes + 1);
                finish_sizes(simd, &mut sum, sign, axes);
                sums.store::<S>(&sum, at, axes + 1);
            }
        }
        Combine::Weighted { k, falloff, gradient } => {
            let mut slope = Sums::new();
            for octave in program.octaves() {
                let mut one = Sums::new();
                add_octave::<S, DEEP>(simd, program.source, octave, block, count, true, &mut one);
                for at in (0..count).step_by(S::LANES) {
                    let mut sum = sums.load(simd, at, 4);
                    let mut so_far = slope.load(simd, at, 4);
                    let octave = one.load(simd, at, 4);
                    add_weighted::<S, true>(simd, &mut sum, &mut so_far, &octave, (k, falloff), axes);
                    sums.store::<S>(&sum, at, 4);
                    slope.store::<S>(&so_far, at, 4);
                }
            }
            for values in &mut sums.0[1..] {
                for value in values {
                    *value *= gradient;
                }
            }
        }
    }
}

#[inline(always)]
fn add_octave<S: Simd, const DEEP: bool>(
    simd: S,
    source: Source,
    octave: &Octave,
    block: &Block,
    count: usize,
    slopes: bool,
    sums: &mut Sums,
) {
    if slopes {
        simd.run(AddOctave::<DEEP, true> { source, octave, block, count, sums });
    } else {
        simd.run(AddOctave::<DEEP, false> { source, octave, block, count, sums });
    }
}

/// Adds one octave to the sums of a block: a function of its own for each level.
struct AddOctave<'a, const DEEP: bool, const SLOPES: bool> {
    source: Source,
    octave: &'a Octave,
    block: &'a Block,
    count: usize,
    sums: &'a mut Sums,
}

impl<const DEEP: bool, const SLOPES: bool> Body for AddOctave<'_, DEEP, SLOPES> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        with_basis::<S, _, DEEP>(simd, self.source, self.octave, self);
    }
}

impl<S: Simd, const DEEP: bool, const SLOPES: bool> Visit<S> for AddOctave<'_, DEEP, SLOPES> {
    #[inline(always)]
    fn visit<B: Basis<S>>(self, simd: S, basis: B) {
        let octave = self.octave;
        let frequency = simd.f64(octave.frequency);
        let [ox, oy, oz] = octave.offset;
        let offset = [simd.f64(ox), simd.f64(oy), simd.f64(oz)];
        let (amplitude, slope) = (simd.f32(octave.amplitude), simd.f32(octave.slope));
        for at in (0..self.count).step_by(S::LANES) {
            let x = Cell::split(simd, simd.load_f64(&self.block.x[at..]), frequency, offset[0]);
            let y = Cell::split(simd, simd.load_f64(&self.block.y[at..]), frequency, offset[1]);
            let z = if B::DEEP { simd.load_f64(&self.block.z[at..]) } else { simd.f64(0.0) };
            let depth = basis.depth(simd, &Cell::split(simd, z, frequency, offset[2]));
            let (columns, rows) = (basis.keys(simd, 0, &x), basis.keys(simd, 1, &y));
            let column = Weights::new(simd, x.t, basis.fade(simd, x.t));
            let row = Weights::new(simd, y.t, basis.fade(simd, y.t));
            let lines = [
                line::<S, B, SLOPES>(simd, basis, columns, rows[0], &depth, &column),
                line::<S, B, SLOPES>(simd, basis, columns, rows[1], &depth, &column),
            ];
            let coefficients = basis.coefficients(simd, &row, amplitude, slope);
            let mut sum = self.sums.load(simd, at, if SLOPES { 4 } else { 1 });
            accumulate::<S, B, SLOPES>(&coefficients, &lines, &mut sum);
            self.sums.store::<S>(&sum, at, if SLOPES { 4 } else { 1 });
        }
    }
}

/// The row vectors between a point's two lattice columns, on the line with that key.
#[inline(always)]
fn line<S: Simd, B: Basis<S>, const SLOPES: bool>(
    simd: S,
    basis: B,
    columns: [S::U32; 2],
    key: S::U32,
    depth: &B::Depth,
    column: &Weights<S>,
) -> Rows<S> {
    let left = basis.point::<SLOPES>(simd, columns[0], key, depth);
    let right = basis.point::<SLOPES>(simd, columns[1], key, depth);
    basis.rows::<SLOPES>(simd, &left, &right, column)
}

/// Adds the octave's value (and slopes) to a sample: the order of these additions is the order of the lattice path.
#[inline(always)]
fn accumulate<S: Simd, B: Basis<S>, const SLOPES: bool>(
    coefficients: &Coefficients<S>,
    lines: &[Rows<S>; 2],
    sum: &mut Sample<S>,
) {
    for line in 0..2 {
        let rows = &lines[line];
        for vector in 0..B::RANK {
            let place = 2 * line + vector;
            sum[0] = coefficients.value[place].mul_add(rows[vector], sum[0]);
            if SLOPES {
                sum[1] = coefficients.along[place].mul_add(rows[2 + vector], sum[1]);
                sum[2] = coefficients.across[place].mul_add(rows[vector], sum[2]);
                if B::DEEP {
                    sum[3] = coefficients.along[place].mul_add(rows[4 + vector], sum[3]);
                }
            }
        }
    }
}
