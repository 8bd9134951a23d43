//! A round brush that spreads a change over the ground around a point.

use super::droplet_paths::UNIT;
use crate::parallel;
use orogen_simd::{Body, Simd, dispatch};

/// A Gaussian truncated at `radius` cells, with a standard deviation of half the radius. Its weights sum to 1 along
/// each axis.
pub struct Brush {
    radius: f64,
    weights: Vec<f32>,
}

impl Brush {
    /// A brush with this radius in cells; 0 spreads nothing.
    #[must_use]
    pub fn new(radius: f64) -> Brush {
        let reach = radius.ceil() as i64;
        let bell = |d: i64| if d == 0 { 1.0 } else { libm::exp(-2.0 * (d * d) as f64 / (radius * radius)) };
        let sum: f64 = (-reach..=reach).map(bell).sum();
        Brush { radius, weights: (-reach..=reach).map(|d| (bell(d) / sum) as f32).collect() }
    }

    /// The radius, in cells.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// The number of cells that the brush covers on each side of its center.
    #[must_use]
    pub fn reach(&self) -> usize {
        self.weights.len() / 2
    }

    /// Converts sums in units to metres and spreads them. `sums` has rows of `width` cells; the result has `border`
    /// cells less on each side.
    #[must_use]
    pub fn over(&self, sums: &[i64], width: usize, border: usize) -> Vec<f32> {
        let (inner, tall) = (width - 2 * border, sums.len() / width - 2 * border);
        let reach = self.reach();
        let first = border - reach;
        let mut rows = vec![0.0f32; inner * (tall + 2 * reach)];
        parallel::for_each_init(
            rows.chunks_mut(inner).enumerate(),
            || vec![0.0f32; inner + 2 * reach],
            |metres, (j, row)| {
                let from = &sums[(first + j) * width + first..][..inner + 2 * reach];
                for (metre, sum) in metres.iter_mut().zip(from) {
                    *metre = (*sum as f64 * UNIT) as f32;
                }
                dispatch(Weighted { weights: &self.weights, from: metres, apart: 1, out: row });
            },
        );
        let mut out = vec![0.0f32; inner * tall];
        parallel::for_each(out.chunks_mut(inner).enumerate(), |(j, row)| {
            dispatch(Weighted { weights: &self.weights, from: &rows[j * inner..], apart: inner, out: row });
        });
        out
    }
}

/// The weighted sum of slices that start `apart` elements after each other.
struct Weighted<'a> {
    weights: &'a [f32],
    from: &'a [f32],
    apart: usize,
    out: &'a mut [f32],
}

impl Body for Weighted<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, _: S) {
        for (step, weight) in self.weights.iter().enumerate() {
            accumulate(self.out, &self.from[step * self.apart..][..self.out.len()], *weight);
        }
    }
}

#[inline(always)]
fn accumulate(out: &mut [f32], row: &[f32], weight: f32) {
    for (sum, sample) in out.iter_mut().zip(row) {
        *sum += weight * sample;
    }
}
