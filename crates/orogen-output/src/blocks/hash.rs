//! Pseudo-random numbers of positions.

use orogen_grid::random::mix64;

/// A hash of a position, the same on every machine.
#[inline]
#[must_use]
pub(super) fn hash(seed: u64, [x, y, z]: [i64; 3]) -> u64 {
    let column =
        mix64(seed ^ (x as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ (y as u64).wrapping_mul(0xC2B2_AE3D_27D4_EB4F));
    mix64(column ^ (z as u64).wrapping_mul(0x1656_67B1_9E37_79F9))
}

/// The upper bits of a hash as a number from 0 to 1, excluding 1.
#[inline]
#[must_use]
pub(super) fn share(hash: u64) -> f64 {
    (hash >> 11) as f64 / (1u64 << 53) as f64
}
