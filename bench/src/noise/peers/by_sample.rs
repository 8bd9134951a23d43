//! Helper for peers that compute one sample per call.

use crate::noise::cases::SIZE;

/// Fills the picture row by row.
#[inline(always)]
pub fn by_sample(out: &mut [f32], sample: impl Fn(f64, f64) -> f32) {
    for (y, row) in out.chunks_exact_mut(SIZE).enumerate() {
        for (x, value) in row.iter_mut().enumerate() {
            *value = sample(x as f64, y as f64);
        }
    }
}
