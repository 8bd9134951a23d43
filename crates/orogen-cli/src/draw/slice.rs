//! The samples of a noise over a lattice one apart.

use std::ops::Range;

use orogen_noise::{Depth, Fractal, Mismatch, Points};
use rayon::prelude::*;

/// How many samples one thread makes at a time.
const PIECE: usize = 1 << 16;

/// A noise in the plane, or a slice of it in space. Sample (i, j) stands at (i, stretch j).
#[derive(Debug, Clone, Copy)]
pub struct Slice {
    /// The noise.
    pub noise: Fractal,
    /// Samples a row.
    pub width: usize,
    /// Where it cuts through space; nowhere is the noise of the plane, another one.
    pub depth: Option<f64>,
    /// From one row to the next.
    pub stretch: f64,
}

impl Slice {
    /// The values of some rows.
    pub fn fill(&self, rows: Range<usize>, value: &mut [f32]) {
        let piece = self.rows_a_piece();
        let xs = self.columns();
        value.par_chunks_mut(piece * self.width).enumerate().for_each(|(n, value)| {
            let ys = self.southings(&rows, n * piece, value.len());
            let points = Points::Lattice { xs: &xs, ys: &ys };
            settle(value, |value| match self.depth {
                None => self.noise.fill(&points, value),
                Some(depth) => self.noise.fill3(&points, &Depth::Slice(depth), value),
            });
        });
    }

    /// The slopes of some rows along x and along y, per sample.
    pub fn fill_slopes(&self, rows: Range<usize>, dx: &mut [f32], dy: &mut [f32]) {
        let piece = self.rows_a_piece();
        let xs = self.columns();
        let pieces = dx.par_chunks_mut(piece * self.width).zip(dy.par_chunks_mut(piece * self.width));
        pieces.enumerate().for_each(|(n, (dx, dy))| {
            let ys = self.southings(&rows, n * piece, dx.len());
            let points = Points::Lattice { xs: &xs, ys: &ys };
            let (mut value, mut dz) = (vec![0.0; dx.len()], vec![0.0; dx.len()]);
            settle(dx, |dx| match self.depth {
                None => self.noise.fill_with_gradient(&points, &mut value, dx, dy),
                Some(depth) => {
                    self.noise.fill3_with_gradient(&points, &Depth::Slice(depth), &mut value, [dx, dy, &mut dz])
                }
            });
        });
    }

    fn rows_a_piece(&self) -> usize {
        (PIECE / self.width).max(1)
    }

    fn columns(&self) -> Vec<f64> {
        (0..self.width).map(|i| i as f64).collect()
    }

    /// Where the rows of a piece stand that begins `skip` rows into `rows` and has `samples`.
    fn southings(&self, rows: &Range<usize>, skip: usize, samples: usize) -> Vec<f64> {
        let first = rows.start + skip;
        (first..first + samples / self.width).map(|j| j as f64 * self.stretch).collect()
    }
}

/// The slices above always have the length of their points; were one ever wrong, it would be NaN and seen.
fn settle(out: &mut [f32], fill: impl FnOnce(&mut [f32]) -> Result<(), Mismatch>) {
    if fill(out).is_err() {
        out.fill(f32::NAN);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_are_the_noises_own_samples() {
        let noise = Fractal { seed: 5, wavelength: 31.0, octaves: 3, ..Fractal::default() };
        for (width, height, depth) in [(7, 5, None), (300, 501, Some(2.5)), (PIECE + 3, 3, None)] {
            let slice = Slice { noise, width, depth, stretch: 1.0 };
            let mut value = vec![0.0; width * (height - 1)];
            slice.fill(1..height, &mut value);
            let (mut dx, mut dy) = (vec![0.0; value.len()], vec![0.0; value.len()]);
            slice.fill_slopes(1..height, &mut dx, &mut dy);
            for k in [0, width - 1, value.len() / 2, value.len() - 1] {
                let (x, y) = ((k % width) as f64, (k / width + 1) as f64);
                let at = |x: f64, y: f64| depth.map_or_else(|| noise.sample(x, y), |z| noise.sample3(x, y, z));
                assert_eq!(value[k], at(x, y), "{k} of {width} x {height}");
                let step = 1.0 / 64.0;
                let east = (at(x + step, y) - at(x - step, y)) * 32.0;
                let south = (at(x, y + step) - at(x, y - step)) * 32.0;
                assert!((dx[k] - east).abs() < 1e-3 && (dy[k] - south).abs() < 1e-3, "{k} of {width} x {height}");
            }
        }
    }
}
