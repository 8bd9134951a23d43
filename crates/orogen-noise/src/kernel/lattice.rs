//! Lattices of samples: strip by strip, row by row, all octaves at once.

#![allow(clippy::needless_range_loop)] // see kernel/mod.rs

use crate::kernel::combine::{Sample, add_size, add_weighted, finish_sizes};
use crate::kernel::outputs::Outputs;
use crate::kernel::strip::{Columns, Job, NO_POINTS, Points, Rows, StripOctave, WIDTH};
use crate::program::{Combine, Program, Source};
use orogen_simd::{Body, F32Lanes, Simd};
use std::cell::Cell;

/// Buffers a thread keeps from call to call.
struct Scratch {
    octaves: Vec<StripOctave>,
    points: Points,
}

thread_local! {
    static SCRATCH: Cell<Option<Box<Scratch>>> = const { Cell::new(None) };
}

/// Fills a lattice; `z` is the depth of the slice in space.
#[inline(always)]
pub(crate) fn fill<S: Simd>(
    simd: S,
    program: &Program,
    (xs, ys, z): (&[f64], &[f64], Option<f64>),
    outputs: &mut Outputs,
) {
    // Taken out and put back: nothing is borrowed while the kernels run.
    let mut scratch = SCRATCH.take().unwrap_or_else(|| Box::new(Scratch { octaves: Vec::new(), points: NO_POINTS }));
    let octaves = program.octaves();
    if scratch.octaves.len() < octaves.len() {
        scratch.octaves.resize_with(octaves.len(), StripOctave::new);
    }
    let Scratch { octaves: strips, points } = &mut *scratch;
    let strips = &mut strips[..octaves.len()];
    let slopes = outputs.slopes.is_some() || matches!(program.combine, Combine::Weighted { .. });
    for (s, columns) in xs.chunks(WIDTH).enumerate() {
        let job = Job {
            source: program.source,
            octave: &octaves.first().copied().unwrap_or_default(),
            limit: program.limit,
            slopes,
            z: z.unwrap_or_default(),
            deep: z.is_some(),
            columns: columns.len(),
        };
        for (strip, octave) in strips.iter_mut().zip(octaves) {
            simd.run(Columns { job: Job { octave, ..job }, strip, xs: columns });
        }
        for (g, rows) in ys.chunks(S::LANES).enumerate() {
            for (strip, octave) in strips.iter_mut().zip(octaves) {
                simd.run(Rows { job: Job { octave, ..job }, strip, ys: rows });
            }
            for r in 0..rows.len() {
                for (strip, octave) in strips.iter_mut().zip(octaves) {
                    strip.hold(simd, &Job { octave, ..job }, points, r);
                }
                let start = (g * S::LANES + r) * xs.len() + s * WIDTH;
                let target = outputs.part(start, columns.len());
                row(simd, program, z.is_some(), Row { combine: program.combine, strips, r, target });
            }
        }
    }
    SCRATCH.set(Some(scratch));
}

/// Runs the kernel made for the row: by the rank of its basis, by how octaves are combined, and by what is wanted.
#[inline(always)]
fn row<S: Simd>(simd: S, program: &Program, deep: bool, row: Row) {
    match (matches!(program.source, Source::Value(_)), deep) {
        (true, false) => rank_and_depth::<S, 1, false>(simd, row),
        (true, true) => rank_and_depth::<S, 1, true>(simd, row),
        (false, false) => rank_and_depth::<S, 2, false>(simd, row),
        (false, true) => rank_and_depth::<S, 2, true>(simd, row),
    }
}

#[inline(always)]
fn rank_and_depth<S: Simd, const RANK: usize, const DEEP: bool>(simd: S, row: Row) {
    // Without slopes, space and plane are the same.
    match (row.combine, row.target.slopes.is_some()) {
        (Combine::Sum, false) => simd.run(RowOf::<RANK, SUM, false, false>(row)),
        (Combine::Sum, true) => simd.run(RowOf::<RANK, SUM, DEEP, true>(row)),
        (Combine::Sizes { .. }, false) => simd.run(RowOf::<RANK, SIZES, false, false>(row)),
        (Combine::Sizes { .. }, true) => simd.run(RowOf::<RANK, SIZES, DEEP, true>(row)),
        (Combine::Weighted { .. }, false) => simd.run(RowOf::<RANK, WEIGHTED, DEEP, false>(row)),
        (Combine::Weighted { .. }, true) => simd.run(RowOf::<RANK, WEIGHTED, DEEP, true>(row)),
    }
}

// Which of the ways to combine a kernel is made for.
const SUM: usize = 0;
const SIZES: usize = 1;
const WEIGHTED: usize = 2;

/// One row of samples within a strip.
struct Row<'a> {
    combine: Combine,
    strips: &'a [StripOctave],
    /// Its place in the group of rows.
    r: usize,
    target: Outputs<'a>,
}

/// The kernel of a row.
struct RowOf<'a, const RANK: usize, const KIND: usize, const DEEP: bool, const SLOPES: bool>(Row<'a>);

impl<const RANK: usize, const KIND: usize, const DEEP: bool, const SLOPES: bool> Body
    for RowOf<'_, RANK, KIND, DEEP, SLOPES>
{
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let mut row = self.0;
        let mut at = 0;
        while at < row.target.value.len() {
            // How many registers are worked on at a time is a matter of speed: enough to hide the latency of the
            // multiply-adds, few enough to stay in registers. All of them divide a strip's width.
            at += S::LANES
                * match (KIND, SLOPES, S::LANES) {
                    (SUM, false, _) => block::<S, DEEP, RANK, 8, KIND, SLOPES>(simd, &mut row, at),
                    // 32 registers instead of 16.
                    (SIZES, false, 16) => block::<S, DEEP, RANK, 8, KIND, SLOPES>(simd, &mut row, at),
                    (SIZES, false, _) | (_, _, 16) => block::<S, DEEP, RANK, 4, KIND, SLOPES>(simd, &mut row, at),
                    _ => block::<S, DEEP, RANK, 2, KIND, SLOPES>(simd, &mut row, at),
                };
        }
    }
}

/// `N` registers of one row, from column `at` on; returns `N`. What lies beyond the last column is made from what an earlier strip
/// left there, and dropped.
#[inline(always)]
fn block<S: Simd, const DEEP: bool, const RANK: usize, const N: usize, const KIND: usize, const SLOPES: bool>(
    simd: S,
    row: &mut Row,
    at: usize,
) -> usize {
    let (combine, strips, r) = (row.combine, row.strips, row.r);
    let target = &mut row.target;
    let axes = if DEEP { 3 } else { 2 };
    let none = [simd.f32(0.0); 4];
    let mut sums = [none; N];
    match combine {
        Combine::Sum if KIND == SUM => {
            for strip in strips {
                add_octave::<S, DEEP, RANK, N, SLOPES>(simd, strip, r, at, &mut sums);
            }
        }
        Combine::Sizes { sign } if KIND == SIZES => {
            let axes = if SLOPES { axes } else { 0 };
            for strip in strips {
                let mut one = [none; N];
                add_octave::<S, DEEP, RANK, N, SLOPES>(simd, strip, r, at, &mut one);
                for n in 0..N {
                    add_size(simd, &mut sums[n], &one[n], axes);
                }
            }
            for n in 0..N {
                finish_sizes(simd, &mut sums[n], sign, axes);
            }
        }
        Combine::Weighted { k, falloff, gradient } if KIND == WEIGHTED => {
            let mut slopes = [none; N];
            for strip in strips {
                let mut one = [none; N];
                add_octave::<S, DEEP, RANK, N, true>(simd, strip, r, at, &mut one);
                for n in 0..N {
                    add_weighted::<S, SLOPES>(simd, &mut sums[n], &mut slopes[n], &one[n], (k, falloff), axes);
                }
            }
            if SLOPES {
                for n in 0..N {
                    for axis in 1..4 {
                        sums[n][axis] = sums[n][axis] * simd.f32(gradient);
                    }
                }
            }
        }
        _ => {}
    }
    for n in 0..N {
        let at = at + n * S::LANES;
        if at >= target.value.len() {
            break;
        }
        sums[n][0].store_partial(&mut target.value[at..]);
        if let (true, Some(slopes)) = (SLOPES, &mut target.slopes) {
            for axis in 0..axes {
                sums[n][1 + axis].store_partial(&mut slopes[axis][at..]);
            }
        }
    }
    N
}

/// Adds one octave to `N` registers of samples.
#[inline(always)]
fn add_octave<S: Simd, const DEEP: bool, const RANK: usize, const N: usize, const SLOPES: bool>(
    simd: S,
    strip: &StripOctave,
    r: usize,
    at: usize,
    sums: &mut [Sample<S>; N],
) {
    let (r, at) = (r & 15, at.min(WIDTH - N * S::LANES));
    for line in 0..2 {
        for vector in 0..RANK {
            let place = 2 * line + vector;
            let coefficients = &strip.coefficients;
            let values = &strip.row(line, vector)[at..at + N * S::LANES];
            let value = simd.f32(coefficients[0][place][r]);
            for n in 0..N {
                sums[n][0] = value.mul_add(simd.load(&values[n * S::LANES..]), sums[n][0]);
            }
            if SLOPES {
                let alongs = &strip.row(line, 2 + vector)[at..at + N * S::LANES];
                let (along, across) = (simd.f32(coefficients[1][place][r]), simd.f32(coefficients[2][place][r]));
                for n in 0..N {
                    sums[n][1] = along.mul_add(simd.load(&alongs[n * S::LANES..]), sums[n][1]);
                    sums[n][2] = across.mul_add(simd.load(&values[n * S::LANES..]), sums[n][2]);
                }
                if DEEP {
                    let deeps = &strip.row(line, 4 + vector)[at..at + N * S::LANES];
                    for n in 0..N {
                        sums[n][3] = along.mul_add(simd.load(&deeps[n * S::LANES..]), sums[n][3]);
                    }
                }
            }
        }
    }
}
