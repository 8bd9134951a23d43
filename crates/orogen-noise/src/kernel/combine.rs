//! How octaves become one number, lane by lane. Lattice and scattered points share these steps.

#![allow(clippy::needless_range_loop)] // see kernel/mod.rs

use crate::choices::Falloff;
use orogen_simd::{F32Lanes, Simd, U32Lanes};

/// A value and its slopes along x, y and z.
pub(crate) type Sample<S> = [<S as Simd>::F32; 4];

/// Adds one octave's size to a sum of sizes; slopes turn with the sign.
#[inline(always)]
pub(crate) fn add_size<S: Simd>(simd: S, sum: &mut Sample<S>, octave: &Sample<S>, axes: usize) {
    let sign = octave[0].bits() & simd.u32(0x8000_0000);
    sum[0] = sum[0] + octave[0].abs();
    for axis in 1..=axes {
        sum[axis] = sum[axis] + (octave[axis].bits() ^ sign).as_f32();
    }
}

/// Turns a sum of sizes, 0 to 2, into ridged (sign -1) or billow (sign 1) noise.
#[inline(always)]
pub(crate) fn finish_sizes<S: Simd>(simd: S, sum: &mut Sample<S>, sign: f32, axes: usize) {
    let sign = simd.f32(sign);
    sum[0] = (sum[0] - simd.f32(1.0)) * sign;
    for axis in 1..=axes {
        sum[axis] = sum[axis] * sign;
    }
}

/// Adds one octave to a weighted sum. `slope` is the slope of the plain sum so far (places 1 to 3). The sum's own slopes are kept
/// where `SLOPES` says so.
#[inline(always)]
pub(crate) fn add_weighted<S: Simd, const SLOPES: bool>(
    simd: S,
    sum: &mut Sample<S>,
    slope: &mut Sample<S>,
    octave: &Sample<S>,
    (k, falloff): (f32, Falloff),
    axes: usize,
) {
    let mut squared = simd.f32(0.0);
    for axis in 1..=axes {
        slope[axis] = slope[axis] + octave[axis];
        squared = slope[axis].mul_add(slope[axis], squared);
    }
    let weight = damping(simd, squared, k, falloff);
    sum[0] = octave[0].mul_add(weight, sum[0]);
    if SLOPES {
        for axis in 1..=axes {
            sum[axis] = octave[axis].mul_add(weight, sum[axis]);
        }
    }
}

/// The factor for a squared slope.
#[inline(always)]
fn damping<S: Simd>(simd: S, squared: S::F32, k: f32, falloff: Falloff) -> S::F32 {
    let (one, k) = (simd.f32(1.0), simd.f32(k));
    match falloff {
        Falloff::Reciprocal => one / squared.mul_add(k, one),
        Falloff::SquareRoot => one / squared.sqrt().mul_add(k, one),
        Falloff::Smoothstep => {
            let t = (squared * k).min(one);
            (t * t).neg_mul_add(t.mul_add(simd.f32(-2.0), simd.f32(3.0)), one)
        }
        Falloff::Exponential => exp_minus(simd, squared * k),
    }
}

/// e^-x for x of 0 and more, within 3 units in the last place; what would be below e^-87 is e^-87.
#[inline(always)]
fn exp_minus<S: Simd>(simd: S, x: S::F32) -> S::F32 {
    let x = x.min(simd.f32(87.0));
    // x = n ln 2 + r, with ln 2 in two pieces so that r keeps its bits.
    let n = x.mul_add(simd.f32(std::f32::consts::LOG2_E), simd.f32(0.5)).floor();
    let r = n.neg_mul_add(simd.f32(1.428_606_8e-6), n.neg_mul_add(simd.f32(0.693_145_75), x));
    // The Taylor polynomial of e^-r for |r| up to ln 2 / 2.
    let mut e = simd.f32(1.0 / 720.0);
    for c in [-1.0 / 120.0, 1.0 / 24.0, -1.0 / 6.0, 0.5, -1.0, 1.0] {
        e = e.mul_add(r, simd.f32(c));
    }
    // Times 2^-n, in the exponent; n is at most 126.
    let power = (simd.u32(127) - n.to_i32()).shl(23).as_f32();
    e * power
}
