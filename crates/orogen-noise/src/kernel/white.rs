//! White noise on lattices of samples: one key per column and per row, and one hash per sample. The values are the same
//! as with the flat bases of [`crate::kernel::value`], but there are no lookups and no interpolation.

#![allow(clippy::needless_range_loop)] // see kernel/mod.rs

use crate::kernel::cell::{Cell, clamp};
use crate::kernel::outputs::Outputs;
use crate::kernel::source::{Hashed, Lattice, value};
use crate::program::{Octave, Program};
use orogen_simd::{Body, F32Lanes, Simd, U32Lanes};

/// Number of columns whose keys are stored at a time, which takes a quarter of a first-level cache.
const WIDTH: usize = 2048;
/// Number of rows whose keys are computed at a time.
const ROWS: usize = 16;

/// Fills a lattice with one octave of white noise.
#[inline(always)]
pub(crate) fn fill<S: Simd>(
    simd: S,
    program: &Program,
    octave: &Octave,
    (xs, ys): (&[f64], &[f64]),
    (dims, depths): (usize, [f64; 2]),
    outputs: &mut Outputs,
) {
    let limit = program.limit;
    let (mut columns, mut rows, mut depth) = (Aligned([0; WIDTH]), [0; ROWS], [0; 2]);
    for axis in 2..dims.min(4) {
        let (at, keys) = (&depths[axis - 2..axis - 1], &mut depth[axis - 2..axis - 1]);
        simd.run(Keys { octave, limit, axis, at, keys });
    }
    for (s, part) in xs.chunks(WIDTH).enumerate() {
        simd.run(Keys { octave, limit, axis: 0, at: part, keys: &mut columns.0 });
        for (g, group) in ys.chunks(ROWS).enumerate() {
            simd.run(Keys { octave, limit, axis: 1, at: group, keys: &mut rows });
            for r in 0..group.len() {
                let start = (g * ROWS + r) * xs.len() + s * WIDTH;
                let to = &mut outputs.value[start..start + part.len()];
                // Keys are combined with xor, so the keys of depths are applied only once per row.
                simd.run(Row {
                    columns: &columns.0,
                    key: rows[r] ^ depth[0] ^ depth[1],
                    amplitude: octave.amplitude,
                    to,
                });
            }
        }
    }
}

#[repr(align(64))]
struct Aligned([u32; WIDTH]);

/// The keys of the cells at positions along an axis.
struct Keys<'a> {
    octave: &'a Octave,
    limit: f64,
    axis: usize,
    at: &'a [f64],
    keys: &'a mut [u32],
}

impl Body for Keys<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Keys { octave, limit, axis, at, keys } = self;
        let lattice = Hashed::new(simd, octave).folded();
        let mut start = 0;
        while start < at.len() {
            let held = clamp(simd, simd.load_f64_partial(&at[start..], 0.0), limit);
            let cell = Cell::split(simd, octave, axis, held);
            lattice.keys(simd, axis, &cell)[0].store_partial(&mut keys[start..]);
            start += S::LANES;
        }
    }
}

/// One row of samples.
struct Row<'a> {
    columns: &'a [u32; WIDTH],
    key: u32,
    amplitude: f32,
    to: &'a mut [f32],
}

impl Body for Row<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Row { columns, key, amplitude, to } = self;
        let (key, amplitude) = (simd.u32(key), simd.f32(amplitude));
        // Whole blocks come first. Their registers are enough to hide the latency of a multiplication.
        let (block, blocks) = (8 * S::LANES, to.len().min(WIDTH) / (8 * S::LANES));
        for b in 0..blocks {
            let (from, to) = (&columns[b * block..][..block], &mut to[b * block..][..block]);
            for n in 0..8 {
                let column = simd.load_u32(&from[n * S::LANES..]);
                sample(simd, column, key, amplitude).store(&mut to[n * S::LANES..]);
            }
        }
        let mut at = blocks * block;
        while at < to.len().min(WIDTH) {
            let column = simd.load_u32(&columns[at.min(WIDTH - S::LANES)..]);
            sample(simd, column, key, amplitude).store_partial(&mut to[at..]);
            at += S::LANES;
        }
    }
}

#[inline(always)]
fn sample<S: Simd>(simd: S, column: S::U32, row: S::U32, amplitude: S::F32) -> S::F32 {
    value(simd, Hashed::<S>::finish_folded(simd, column ^ row)) * amplitude
}
