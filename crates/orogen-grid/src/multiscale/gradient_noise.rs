//! Gradient noise for the geography, in double precision, because positions may be millions of kilometres from the
//! origin.

use super::hash;

/// The depth in hashes of the gradient lattice. No level has this depth.
const DEPTH: usize = 77;

/// East components of the gradients of the first quarter turn, in steps of a 16th of a turn.
const QUARTER: [f64; 4] = [1.0, 0.923_88, std::f64::consts::FRAC_1_SQRT_2, 0.382_68];

/// East components of the 16 gradients. The south component equals the east component of the gradient a quarter turn
/// back.
const GRADIENTS: [f64; 16] = {
    let [a, b, c, d] = QUARTER;
    [a, b, c, d, 0.0, -d, -c, -b, -a, -b, -c, -d, 0.0, d, c, b]
};

/// Noise with a wavelength of 1, about -1 to 1.
pub fn noise(seed: u64, stream: u64, x: f64, y: f64) -> f64 {
    let (column, row) = (floor(x), floor(y));
    let (u, v) = (x - column as f64, y - row as f64);
    let slope = |column: i64, row: i64, u: f64, v: f64| {
        let turn = (hash::node(seed, DEPTH, column, row, stream) >> 40) as usize & 15;
        GRADIENTS[turn] * u + GRADIENTS[(turn + 12) & 15] * v
    };
    let (right, bottom) = (column.wrapping_add(1), row.wrapping_add(1));
    let (share_u, share_v) = (quintic(u), quintic(v));
    let (a, b) = (slope(column, row, u, v), slope(right, row, u - 1.0, v));
    let (c, d) = (slope(column, bottom, u, v - 1.0), slope(right, bottom, u - 1.0, v - 1.0));
    let (north, south) = (a + share_u * (b - a), c + share_u * (d - c));
    (north + share_v * (south - north)) * 1.4
}

/// The largest integer that is not larger than `x`, without a function call as in `f64::floor` on older processors.
fn floor(x: f64) -> i64 {
    let towards_zero = x as i64;
    if towards_zero as f64 > x { towards_zero.wrapping_sub(1) } else { towards_zero }
}

fn quintic(t: f64) -> f64 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

/// 0 below `from`, 1 above `to`, and smooth between them.
pub fn smooth_step(from: f64, to: f64, x: f64) -> f64 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
