//! Interpolation curves between lattice points, with their slopes.

use crate::choices::Fade;
use orogen_simd::{F32Lanes, Simd};

/// 6 t^5 - 15 t^4 + 10 t^3 and its slope 30 t^2 (t - 1)^2.
///
/// Written around the center, with s = t - 1/2, it is the odd polynomial 1/2 + s (15/8 - 5 s^2 + 6 s^4). This form is
/// exact at both ends and within 1e-7 everywhere. The usual form has terms of size 10 that cancel near t = 1.
#[inline(always)]
pub(crate) fn quintic<S: Simd>(simd: S, t: S::F32) -> [S::F32; 2] {
    let half = simd.f32(0.5);
    let s = t - half;
    let q = s * s;
    let p = q.mul_add(q.mul_add(simd.f32(6.0), simd.f32(-5.0)), simd.f32(1.875));
    let bump = t * (t - simd.f32(1.0));
    [s.mul_add(p, half), bump * bump * simd.f32(30.0)]
}

/// The fade and its slope.
#[inline(always)]
pub(crate) fn fade<S: Simd>(simd: S, fade: Fade, t: S::F32) -> [S::F32; 2] {
    match fade {
        Fade::Quintic => quintic(simd, t),
        Fade::Cubic => {
            let bump = t * (simd.f32(1.0) - t);
            [t.mul_add(simd.f32(-2.0), simd.f32(3.0)) * (t * t), bump * simd.f32(6.0)]
        }
        Fade::Linear => [t, simd.f32(1.0)],
        Fade::Step => [simd.f32(0.0); 2],
    }
}
