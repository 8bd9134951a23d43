/* origin: FreeBSD /usr/src/lib/msun/src/s_atanf.c */
/*
 * Conversion to float by Ian Lance Taylor, Cygnus Support, ian@cygnus.com.
 */
/*
 * ====================================================
 * Copyright (C) 1993 by Sun Microsystems, Inc. All rights reserved.
 *
 * Developed at SunPro, a Sun Microsystems, Inc. business.
 * Permission to use, copy, modify, and distribute this
 * software is freely granted, provided that this notice
 * is preserved.
 * ====================================================
 */

//! Written without branches, with the operations of the origin in their order: the same bits, and loops over many
//! values use vectors.

const A_T: [f32; 5] = [3.3333328366e-01, -1.9999158382e-01, 1.4253635705e-01, -1.0648017377e-01, 6.1687607318e-02];

/// Arctangent (f32)
///
/// Computes the inverse tangent (arc tangent) of the input value.
/// Returns a value in radians, in the range of -pi/2 to pi/2.
#[inline]
#[must_use]
pub fn atanf(x: f32) -> f32 {
    let a = f32::abs(x);
    /* argument reduction: atan(a) = hi + lo + atan(above / below) */
    let (above, below, hi, lo) = (a, 1., 0., 0.);
    /*  7/16 <= |x| < 11/16: atan(0.5) */
    let (above, below, hi, lo) = if a >= 0.4375 {
        (2. * a - 1., 2. + a, 4.6364760399e-01 /* 0x3eed6338 */, 5.0121582440e-09 /* 0x31ac3769 */)
    } else {
        (above, below, hi, lo)
    };
    /* 11/16 <= |x| < 19/16: atan(1.0) */
    let (above, below, hi, lo) = if a >= 0.6875 {
        (a - 1., a + 1., 7.8539812565e-01 /* 0x3f490fda */, 3.7748947079e-08 /* 0x33222168 */)
    } else {
        (above, below, hi, lo)
    };
    /* 19/16 <= |x| < 39/16: atan(1.5) */
    let (above, below, hi, lo) = if a >= 1.1875 {
        (a - 1.5, 1. + 1.5 * a, 9.8279368877e-01 /* 0x3f7b985e */, 3.4473217170e-08 /* 0x33140fb4 */)
    } else {
        (above, below, hi, lo)
    };
    /* 39/16 <= |x|: atan(inf) */
    let (above, below, hi, lo) = if a >= 2.4375 {
        (-1., a, 1.5707962513e+00 /* 0x3fc90fda */, 7.5497894159e-08 /* 0x33a22168 */)
    } else {
        (above, below, hi, lo)
    };
    let t = above / below;
    let z = t * t;
    let w = z * z;
    /* break sum from i=0 to 10 aT[i]z**(i+1) into odd and even poly */
    let s1 = z * (A_T[0] + w * (A_T[2] + w * A_T[4]));
    let s2 = w * (A_T[1] + w * A_T[3]);
    let angle = hi - ((t * (s1 + s2) - lo) - t);
    /* |x| >= 2**26 */
    let angle = if a >= 67108864. { 1.5707962513e+00 } else { angle };
    let angle = f32::from_bits(angle.to_bits() | (x.to_bits() & 0x80000000));
    /* |x| < 2**-12, and NaN */
    if a >= 0.00024414062 { angle } else { x }
}
