//! Lattices of samples: strip by strip and row by row, with all octaves of a row together.

#![allow(clippy::needless_range_loop)] // see kernel/mod.rs

use crate::kernel::combine::{Sample, State};
use crate::kernel::outputs::Outputs;
use crate::kernel::strip::{Columns, Job, NO_POINTS, Points, Rows, StripOctave, WIDTH};
use crate::program::{Combine, Octave, Program, Source};
use orogen_simd::{Body, F32Lanes, Simd, Stream, streaming};
use std::cell::Cell;

/// Minimum number of columns of a wide window, and number of rows that all its strips fill before the next rows.
const WIDE: usize = 4096;
const BAND: usize = 64;

/// Minimum number of samples of results that are larger than the caches.
const HUGE: usize = 1 << 24;

/// Buffers that a thread keeps between calls.
struct Scratch {
    octaves: Vec<StripOctave>,
    points: Points,
}

thread_local! {
    static SCRATCH: Cell<Option<Box<Scratch>>> = const { Cell::new(None) };
}

/// Whether there are kernels for this case. Rare cases are evaluated point by point, because kernels for them would
/// double the size of the code.
pub(crate) fn covers(program: &Program, dims: usize, slopes: bool) -> bool {
    let shaped = matches!(program.combine, Combine::Shaped { .. });
    !(slopes && shaped) && !(dims == 4 && (slopes || program.combine.needs_slopes()))
}

/// Fills a lattice for which [`covers`] returns true. `depths` are z and w of the slice, as required by `dims`.
#[inline(always)]
pub(crate) fn fill<S: Simd>(
    simd: S,
    program: &Program,
    (xs, ys): (&[f64], &[f64]),
    (dims, depths): (usize, [f64; 2]),
    outputs: &mut Outputs,
) {
    // The buffers are moved out and back, so nothing is borrowed while the kernels run.
    let mut scratch = SCRATCH.take().unwrap_or_else(|| Box::new(Scratch { octaves: Vec::new(), points: NO_POINTS }));
    let octaves = program.octaves();
    if scratch.octaves.len() < octaves.len() {
        scratch.octaves.resize_with(octaves.len(), StripOctave::new);
    }
    let Scratch { octaves: strips, points } = &mut *scratch;
    let strips = &mut strips[..octaves.len()];
    let whole = Whole { simd, program, xs, ys, dims, depths };
    if xs.len() > WIDE && xs.len() * ys.len() >= HUGE {
        // Whole registers are stored past the caches, so the first strip ends at an aligned address.
        let register = S::LANES * size_of::<f32>();
        let beyond = outputs.value.as_ptr().addr() % register;
        let lead = (register - beyond) % register / size_of::<f32>();
        streaming(|stream| whole.fill((strips, points), outputs, lead, Some(stream)));
    } else {
        whole.fill((strips, points), outputs, 0, None);
    }
    SCRATCH.set(Some(scratch));
}

/// A lattice that is to be filled.
struct Whole<'a, S> {
    simd: S,
    program: &'a Program,
    xs: &'a [f64],
    ys: &'a [f64],
    dims: usize,
    depths: [f64; 2],
}

impl<S: Simd> Whole<'_, S> {
    /// Fills the lattice strip by strip. The first strip has `lead` columns.
    #[inline(always)]
    fn fill(
        &self,
        (strips, points): (&mut [StripOctave], &mut Points),
        outputs: &mut Outputs,
        lead: usize,
        stream: Option<&Stream>,
    ) {
        let Whole { simd, program, xs, ys, dims, depths } = *self;
        let octaves = program.octaves();
        let slopes = outputs.slopes.is_some() || program.combine.needs_slopes();
        let (first, others) = xs.split_at(lead.min(xs.len()));
        // Rows of a wide window are far apart in memory and lie in different pages. A strip therefore covers only a
        // band of rows at a time.
        let band = if xs.len() > WIDE { BAND } else { ys.len().max(1) };
        for (b, band_ys) in ys.chunks(band).enumerate() {
            let mut column = 0;
            for columns in first.chunks(WIDTH).chain(others.chunks(WIDTH)) {
                let (source, limit) = (program.source, program.limit);
                let job = Job { source, limit, slopes, dims, depths, columns: columns.len() };
                for (strip, octave) in strips.iter_mut().zip(octaves) {
                    simd.run(Columns { job: &job, octave, strip, xs: columns });
                }
                for (g, rows) in band_ys.chunks(S::LANES).enumerate() {
                    for (strip, octave) in strips.iter_mut().zip(octaves) {
                        simd.run(Rows { job: &job, octave, strip, ys: rows });
                    }
                    for r in 0..rows.len() {
                        for (strip, octave) in strips.iter_mut().zip(octaves) {
                            strip.hold(simd, &job, octave, points, r);
                        }
                        let start = (b * band + g * S::LANES + r) * xs.len() + column;
                        let target = outputs.part(start, columns.len());
                        let row = Row { combine: &program.combine, octaves, strips, r, target, stream };
                        if matches!(program.source, Source::Value(_)) {
                            in_dimensions::<S, 1>(simd, dims, row);
                        } else {
                            in_dimensions::<S, 2>(simd, dims, row);
                        }
                    }
                }
                column += columns.len();
            }
        }
    }
}

/// Runs the kernel for the rank of the basis, the combination of octaves, and the requested results.
#[inline(always)]
fn in_dimensions<S: Simd, const RANK: usize>(simd: S, dims: usize, row: Row) {
    // Without slopes the kernel is the same in all dimensions.
    match (dims, row.target.slopes.is_some() || row.combine.needs_slopes()) {
        (_, false) => of_kind::<S, RANK, 2>(simd, row),
        (2, true) => of_kind::<S, RANK, 2>(simd, row),
        (_, true) => of_kind::<S, RANK, 3>(simd, row),
    }
}

#[inline(always)]
fn of_kind<S: Simd, const RANK: usize, const DIMS: usize>(simd: S, row: Row) {
    match (row.combine, row.target.slopes.is_some()) {
        (Combine::Sum, false) => simd.run(RowOf::<RANK, SUM, 2, false>(row)),
        (Combine::Sum, true) => simd.run(RowOf::<RANK, SUM, DIMS, true>(row)),
        (Combine::Sizes { .. }, false) => simd.run(RowOf::<RANK, SIZES, 2, false>(row)),
        (Combine::Sizes { .. }, true) => simd.run(RowOf::<RANK, SIZES, DIMS, true>(row)),
        (Combine::Weighted { .. }, false) => simd.run(RowOf::<RANK, WEIGHTED, DIMS, false>(row)),
        (Combine::Weighted { .. }, true) => simd.run(RowOf::<RANK, WEIGHTED, DIMS, true>(row)),
        (Combine::Shaped { .. }, _) => simd.run(RowOf::<RANK, SHAPED, 2, false>(row)),
    }
}

// The combinations for which kernels are compiled.
const SUM: usize = 0;
const SIZES: usize = 1;
const WEIGHTED: usize = 2;
const SHAPED: usize = 3;

/// One row of samples within a strip.
struct Row<'a> {
    combine: &'a Combine,
    octaves: &'a [Octave],
    strips: &'a [StripOctave],
    /// The index of the row in its group.
    r: usize,
    target: Outputs<'a>,
    /// Set if stores bypass the caches.
    stream: Option<&'a Stream>,
}

/// The kernel of a row.
struct RowOf<'a, const RANK: usize, const KIND: usize, const DIMS: usize, const SLOPES: bool>(Row<'a>);

impl<const RANK: usize, const KIND: usize, const DIMS: usize, const SLOPES: bool> Body
    for RowOf<'_, RANK, KIND, DIMS, SLOPES>
{
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let mut row = self.0;
        let mut at = 0;
        while at < row.target.value.len() {
            // The number of registers per step affects only the speed. It is large enough to hide the latency of the
            // multiply-adds and small enough for the register file. All numbers divide the width of a strip.
            at += S::LANES
                * match (KIND, SLOPES, S::LANES) {
                    (SUM, false, _) => block::<S, DIMS, RANK, 8, KIND, SLOPES>(simd, &mut row, at),
                    // AVX-512 has 32 registers instead of 16.
                    (SIZES, false, 16) => block::<S, DIMS, RANK, 8, KIND, SLOPES>(simd, &mut row, at),
                    (SIZES, false, _) | (WEIGHTED, _, 16) | (SUM | SIZES, true, 16) => {
                        block::<S, DIMS, RANK, 4, KIND, SLOPES>(simd, &mut row, at)
                    }
                    _ => block::<S, DIMS, RANK, 2, KIND, SLOPES>(simd, &mut row, at),
                };
        }
    }
}

/// Computes `N` registers of one row, from column `at` on; returns `N`. Lanes beyond the last column read values of an
/// earlier strip, and their results are dropped.
#[inline(always)]
fn block<S: Simd, const DIMS: usize, const RANK: usize, const N: usize, const KIND: usize, const SLOPES: bool>(
    simd: S,
    row: &mut Row,
    at: usize,
) -> usize {
    let (combine, r) = (row.combine, row.r);
    let none = [simd.f32(0.0); 5];
    let mut states = [State::new(simd); N];
    for o in 0..row.strips.len().min(row.octaves.len()) {
        let (strip, octave) = (&row.strips[o], &row.octaves[o]);
        let mut one = [none; N];
        match combine {
            // A plain sum accumulates across octaves.
            Combine::Sum if KIND == SUM => {
                for n in 0..N {
                    one[n] = states[n].sum;
                }
                add_octave::<S, DIMS, RANK, N, SLOPES>(simd, strip, r, at, &mut one);
                for n in 0..N {
                    states[n].sum = one[n];
                }
            }
            Combine::Sizes { .. } if KIND == SIZES => {
                add_octave::<S, DIMS, RANK, N, SLOPES>(simd, strip, r, at, &mut one);
                for n in 0..N {
                    states[n].add::<SLOPES>(simd, combine, octave, &one[n], DIMS);
                }
            }
            Combine::Weighted { .. } if KIND == WEIGHTED => {
                add_octave::<S, DIMS, RANK, N, true>(simd, strip, r, at, &mut one);
                for n in 0..N {
                    states[n].add::<SLOPES>(simd, combine, octave, &one[n], DIMS);
                }
            }
            Combine::Shaped { .. } if KIND == SHAPED => {
                add_octave::<S, DIMS, RANK, N, SLOPES>(simd, strip, r, at, &mut one);
                for n in 0..N {
                    states[n].add::<SLOPES>(simd, combine, octave, &one[n], DIMS);
                }
            }
            _ => {}
        }
    }
    for n in 0..N {
        match combine {
            Combine::Sizes { .. } if KIND == SIZES => states[n].finish::<SLOPES>(simd, combine, DIMS),
            Combine::Weighted { .. } if KIND == WEIGHTED => states[n].finish::<SLOPES>(simd, combine, DIMS),
            Combine::Shaped { .. } if KIND == SHAPED => states[n].finish::<SLOPES>(simd, combine, DIMS),
            _ => {}
        }
    }
    let target = &mut row.target;
    if let Some(stream) = row.stream {
        for n in 0..N {
            let from = (at + n * S::LANES).min(target.value.len());
            states[n].sum[0].stream(&mut target.value[from..], stream);
        }
    }
    for n in 0..N {
        let at = at + n * S::LANES;
        if at >= target.value.len() {
            break;
        }
        if row.stream.is_none() {
            states[n].sum[0].store_partial(&mut target.value[at..]);
        }
        if let (true, Some(slopes)) = (SLOPES, &mut target.slopes) {
            for axis in 0..DIMS {
                states[n].sum[1 + axis].store_partial(&mut slopes[axis][at..]);
            }
        }
    }
    N
}

/// Adds one octave to `N` registers of samples.
#[inline(always)]
fn add_octave<S: Simd, const DIMS: usize, const RANK: usize, const N: usize, const SLOPES: bool>(
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
                for axis in 2..DIMS {
                    let deeps = &strip.row(line, 2 * axis + vector)[at..at + N * S::LANES];
                    for n in 0..N {
                        sums[n][1 + axis] = along.mul_add(simd.load(&deeps[n * S::LANES..]), sums[n][1 + axis]);
                    }
                }
            }
        }
    }
}
