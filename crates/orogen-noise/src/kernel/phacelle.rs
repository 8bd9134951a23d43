//! Phacelle noise: stripes along a direction that is given for each sample.

#![allow(clippy::needless_range_loop)] // see kernel/mod.rs

use crate::kernel::cell::{Cell, clamp, coordinate};
use crate::kernel::combine::exp_minus;
use crate::kernel::places::{BLOCK, positions};
use crate::kernel::source::{Hashed, Lattice};
use crate::points::Points;
use crate::program::Program;
use orogen_simd::{Body, F32Lanes, Simd, U32Lanes};

/// Direction of the stripes.
#[derive(Clone, Copy)]
pub(crate) enum Along<'a> {
    /// The same direction everywhere.
    One([f32; 2]),
    /// A direction for each sample, of any length.
    Each([&'a [f32]; 2]),
}

/// One call of a public fill.
pub(crate) struct Fill<'a> {
    /// One octave: the lattice of cells.
    pub program: &'a Program,
    pub points: Points<'a>,
    pub along: Along<'a>,
    /// Number of stripes per cell.
    pub stripes: f32,
    /// Minimum length that a wave is divided by.
    pub shortest: f32,
    pub cosine: &'a mut [f32],
    /// The sines, as many as cosines, or empty if not requested.
    pub sine: &'a mut [f32],
}

impl Body for Fill<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Fill { program, points, along, stripes, shortest, cosine, sine } = self;
        let (mut x, mut y) = ([0.0; BLOCK], [0.0; BLOCK]);
        for start in (0..points.len()).step_by(BLOCK) {
            let count = BLOCK.min(points.len() - start);
            let at = positions(simd, &points, start, [&mut x[..count], &mut y[..count]]);
            let part = |slice: &[f32]| start.min(slice.len())..(start + count).min(slice.len());
            let along = match along {
                Along::One(way) => Along::One(way),
                Along::Each([dx, dy]) => Along::Each([&dx[part(dx)], &dy[part(dy)]]),
            };
            let (cosine, sine) = (&mut cosine[start..start + count], {
                let range = part(sine);
                &mut sine[range]
            });
            simd.run(Block { program, at, along, stripes, shortest, cosine, sine });
        }
    }
}

struct Block<'a> {
    program: &'a Program,
    at: [&'a [f64]; 2],
    along: Along<'a>,
    stripes: f32,
    shortest: f32,
    cosine: &'a mut [f32],
    sine: &'a mut [f32],
}

impl Body for Block<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Block { program, at, along, stripes, shortest, cosine, sine } = self;
        let Some(octave) = program.octaves().first() else { return };
        let lattice = Hashed::<S>::new(simd, octave);
        let (zero, one) = (simd.f32(0.0), simd.f32(1.0));
        let mut start = 0;
        while start < cosine.len() {
            let mut cells = [Cell::at(simd, simd.f64(0.0)); 2];
            for axis in 0..2 {
                let from = at[axis].get(start..).unwrap_or_default();
                let held = clamp(simd, simd.load_f64_partial(from, 0.0), program.limit);
                cells[axis] = Cell::of(simd, coordinate(simd, octave, axis, held));
            }
            let [dx, dy] = match along {
                Along::One([dx, dy]) => [simd.f32(dx), simd.f32(dy)],
                Along::Each([dx, dy]) => [simd.load_partial(&dx[start..], 0.0), simd.load_partial(&dy[start..], 0.0)],
            };
            // Turns per cell across the stripes. A direction with a length of 0 or NaN gives none.
            let length = dy.mul_add(dy, dx * dx).sqrt();
            let sensible = zero.lt(length) & length.lt(simd.f32(f32::MAX));
            let scale = (simd.f32(stripes) / length).select(sensible, zero);
            let side = [(-dy * scale).select(sensible, zero), (dx * scale).select(sensible, zero)];
            let mut keys = [[simd.u32(0); 4]; 2];
            for axis in 0..2 {
                for step in 0..4 {
                    let whole = cells[axis].whole + simd.f64(step as f64 - 1.0);
                    keys[axis][step] = lattice.keys(simd, axis, &Cell::at(simd, whole))[0];
                }
            }
            let (mut wave, mut weights) = ([zero; 2], zero);
            for number in 0..16 {
                let (i, j) = (number & 3, number >> 2);
                let hash = lattice.hash::<2>(simd, [keys[0][i], keys[1][j], keys[0][i], keys[0][i]]);
                let second = (hash ^ hash.shr(16)) * simd.u32(0x93D7_65DD);
                let third = (second ^ second.shr(15)) * simd.u32(0x915F_77F5);
                // Each pivot is within half a cell of its lattice point.
                let jitter = [unit(simd, hash) - simd.f32(0.5), unit(simd, second) - simd.f32(0.5)];
                let v = [
                    cells[0].t - (jitter[0] + simd.f32(i as f32 - 1.0)),
                    cells[1].t - (jitter[1] + simd.f32(j as f32 - 1.0)),
                ];
                let squared = v[1].mul_add(v[1], v[0] * v[0]);
                let weight = (exp_minus(simd, squared + squared) - simd.f32(LEAST)).max(zero);
                let turns = v[1].mul_add(side[1], v[0] * side[0]) + unit(simd, third);
                let [cos, sin] = circle(simd, turns);
                wave = [weight.mul_add(cos, wave[0]), weight.mul_add(sin, wave[1])];
                weights = weights + weight;
            }
            wave = [wave[0] / weights, wave[1] / weights];
            let length = wave[1].mul_add(wave[1], wave[0] * wave[0]).sqrt().max(simd.f32(shortest));
            wave = [wave[0] / length, wave[1] / length];
            for place in 0..2 {
                wave[place] = wave[place].max(-one).min(one);
            }
            wave[0].store_partial(&mut cosine[start..]);
            if !sine.is_empty() {
                wave[1].store_partial(&mut sine[start..]);
            }
            start += S::LANES;
        }
    }
}

/// e^(-2 1.5^2), which is subtracted from weights so that they are 0 at a distance of one and a half cells.
const LEAST: f32 = 0.011_108_997;

/// A hash as a number from 0 (included) to 1 (excluded).
#[inline(always)]
fn unit<S: Simd>(simd: S, hash: S::U32) -> S::F32 {
    hash.shr(8).i32_to_f32() * simd.f32(1.0 / 16_777_216.0)
}

/// Cosine and sine of a number of turns, within 4e-7.
#[inline(always)]
fn circle<S: Simd>(simd: S, turns: S::F32) -> [S::F32; 2] {
    // Quarter turns from the nearest integer. An odd number of them swaps sine and cosine.
    let quarters = turns * simd.f32(4.0);
    let whole = (quarters + simd.f32(0.5)).floor();
    let a = (quarters - whole) * simd.f32(std::f32::consts::FRAC_PI_2);
    let s = a * a;
    let mut cos = simd.f32(1.0 / 40_320.0);
    for c in [-1.0 / 720.0, 1.0 / 24.0, -0.5, 1.0] {
        cos = cos.mul_add(s, simd.f32(c));
    }
    let mut sin = simd.f32(1.0 / 362_880.0);
    for c in [-1.0 / 5040.0, 1.0 / 120.0, -1.0 / 6.0, 1.0] {
        sin = sin.mul_add(s, simd.f32(c));
    }
    let sin = sin * a;
    let number = whole.to_i32();
    let even = (number & simd.u32(1)).eq(simd.u32(0));
    // The cosine changes its sign in quarters 1 and 2, the sine in 2 and 3.
    let turn = |number: S::U32| (number & simd.u32(2)).shl(30);
    let (first, second) = (turn(number + simd.u32(1)), turn(number));
    [(cos.select(even, sin).bits() ^ first).as_f32(), (sin.select(even, cos).bits() ^ second).as_f32()]
}
