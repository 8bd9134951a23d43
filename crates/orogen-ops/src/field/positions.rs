//! Iteration over positions in every representation.

use orogen_grid::resample::NOWHERE;
use orogen_noise::Points;

/// Time for evaluating a segment of a drawing, in nanoseconds.
pub(super) const SEGMENT_COST: f64 = 10.0;

/// Writes `value(x, y)` for each position, in metres.
pub(super) fn each(at: &Points, out: &mut [f32], mut value: impl FnMut(f64, f64) -> f32) {
    change(at, out, |x, y, _| value(x, y));
}

/// Replaces the value at each position by `value(x, y, before)`, with the position in metres and the previous value.
pub(super) fn change(at: &Points, out: &mut [f32], mut value: impl FnMut(f64, f64, f32) -> f32) {
    match at {
        Points::Lattice { xs, ys } if !xs.is_empty() => {
            for (row, y) in out.chunks_mut(xs.len()).zip(ys.iter()) {
                for (sample, x) in row.iter_mut().zip(xs.iter()) {
                    *sample = value(*x, *y, *sample);
                }
            }
        }
        _ => {
            for (k, sample) in out.iter_mut().enumerate() {
                let (x, y) = at.position(k).unwrap_or(NOWHERE);
                *sample = value(x, y, *sample);
            }
        }
    }
}

/// The smoothstep 3 t^2 - 2 t^3 from 0 at 0 to 1 at 1, constant beyond.
pub(super) fn smoothstep(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_ways_agree() {
        let (xs, ys) = ([1.0, 2.5, -3.0], [0.5, 7.0]);
        let (x, y) = ([1.0, 2.5, -3.0, 1.0, 2.5, -3.0], [0.5, 0.5, 0.5, 7.0, 7.0, 7.0]);
        let (mut a, mut b) = ([0.0; 6], [0.0; 6]);
        each(&Points::Lattice { xs: &xs, ys: &ys }, &mut a, |x, y| (x * 10.0 + y) as f32);
        each(&Points::Scattered { x: &x, y: &y }, &mut b, |x, y| (x * 10.0 + y) as f32);
        assert_eq!(a, b);
        assert_eq!(a[4], 32.0);
        change(&Points::Scattered { x: &x, y: &y }, &mut a, |x, _, before| before - (x * 10.0) as f32);
        assert_eq!(a, [0.5, 0.5, 0.5, 7.0, 7.0, 7.0]);
    }
}
