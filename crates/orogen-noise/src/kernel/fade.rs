//! The blends between lattice points, with their slopes.

use crate::value::Fade;
use orogen_simd::{F32Lanes, Simd};

/// 6 t^5 - 15 t^4 + 10 t^3 and its slope 30 t^2 (t - 1)^2.
#[inline(always)]
pub(crate) fn quintic<S: Simd>(simd: S, t: S::F32) -> [S::F32; 2] {
    let inner = t.mul_add(t.mul_add(simd.f32(6.0), simd.f32(-15.0)), simd.f32(10.0));
    let bump = t * (t - simd.f32(1.0));
    [inner * (t * t * t), bump * bump * simd.f32(30.0)]
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
