//! The samples of a noise on a lattice of unit distance.

use std::ops::Range;

use orogen_grid::parallel;
use orogen_noise::{Depth, Fractal, LengthMismatch, Points, TileError, Tiled};

use super::fit::{Fit, Lengths};

/// Number of samples that a thread computes at a time.
const PIECE: usize = 1 << 16;

/// 2D noise, or a slice of 3D noise. Sample (i, j) is at (i, stretch j). If the picture repeats, steps are adjusted
/// slightly, so that a whole number of wavelengths fits.
#[derive(Debug, Clone, Copy)]
pub struct Slice {
    /// The noise.
    pub noise: Fractal,
    /// Samples per row.
    pub width: usize,
    /// Depth of the slice, in samples; `None` for 2D noise, which differs from any slice.
    pub depth: Option<f64>,
    /// Distance between rows.
    pub stretch: f64,
    /// Periods of the picture.
    pub repeat: Lengths,
}

impl Slice {
    /// The adjusted wavelengths.
    #[must_use]
    pub fn fit(&self) -> Fit {
        let [x, y, depth] = self.repeat;
        Fit::new(self.noise.wavelength, [x, y * self.stretch, depth])
    }

    /// The noise with its periods.
    pub fn tiled(&self) -> Result<Tiled, TileError> {
        self.noise.tiled(self.fit().cells)
    }

    /// The values of some rows.
    pub fn fill(&self, rows: Range<usize>, value: &mut [f32]) {
        let piece = self.rows_a_piece();
        let xs = self.columns();
        parallel::for_each(value.chunks_mut(piece * self.width).enumerate(), |(n, value)| {
            let ys = self.southings(&rows, n * piece, value.len());
            let points = Points::Lattice { xs: &xs, ys: &ys };
            self.settle(value, |noise, value| match self.cut() {
                None => noise.fill(&points, value),
                Some(depth) => noise.fill3(&points, &depth, value),
            });
        });
    }

    /// The derivatives of some rows along x and along y, per sample.
    pub fn fill_slopes(&self, rows: Range<usize>, dx: &mut [f32], dy: &mut [f32]) {
        let piece = self.rows_a_piece();
        let xs = self.columns();
        let [east, south, _] = self.fit().steps.map(|step| step as f32);
        let pieces = dx.chunks_mut(piece * self.width).zip(dy.chunks_mut(piece * self.width));
        parallel::for_each(pieces.enumerate(), |(n, (dx, dy))| {
            let ys = self.southings(&rows, n * piece, dx.len());
            let points = Points::Lattice { xs: &xs, ys: &ys };
            let (mut value, mut dz) = (vec![0.0; dx.len()], vec![0.0; dx.len()]);
            self.settle(dx, |noise, dx| match self.cut() {
                None => noise.fill_with_gradient(&points, &mut value, dx, dy),
                Some(depth) => noise.fill3_with_gradient(&points, &depth, &mut value, [dx, dy, &mut dz]),
            });
            dx.iter_mut().for_each(|slope| *slope *= east);
            dy.iter_mut().for_each(|slope| *slope *= south);
        });
    }

    fn cut(&self) -> Option<Depth<'static>> {
        self.depth.map(|depth| Depth::Slice(depth * self.fit().steps[2]))
    }

    fn rows_a_piece(&self) -> usize {
        (PIECE / self.width).max(1)
    }

    fn columns(&self) -> Vec<f64> {
        let step = self.fit().steps[0];
        (0..self.width).map(|i| i as f64 * step).collect()
    }

    /// The southings of the `samples` of a piece that starts `skip` rows after the start of `rows`.
    fn southings(&self, rows: &Range<usize>, skip: usize, samples: usize) -> Vec<f64> {
        let first = rows.start + skip;
        let step = self.stretch * self.fit().steps[1];
        (first..first + samples / self.width).map(|j| j as f64 * step).collect()
    }

    /// The slices above always have the length of their points, and the periods were checked before. An unexpected
    /// error would give visible NaN.
    fn settle(&self, out: &mut [f32], fill: impl FnOnce(&Tiled, &mut [f32]) -> Result<(), LengthMismatch>) {
        match self.tiled() {
            Ok(noise) if fill(&noise, out).is_ok() => {}
            _ => out.fill(f32::NAN),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_are_the_noises_own_samples() {
        let noise = Fractal::new(5, 31.0).with_octaves(3);
        for (width, height, depth) in [(7, 5, None), (300, 501, Some(2.5)), (PIECE + 3, 3, None)] {
            let slice = Slice { noise, width, depth, stretch: 1.0, repeat: [0.0; 3] };
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
    #[test]
    fn what_repeats_is_the_tiled_noise_at_steps_that_fit() {
        let noise = Fractal::new(5, 30.0).with_octaves(3);
        let slice = Slice { noise, width: 70, depth: Some(4.0), stretch: 0.5, repeat: [70.0, 90.0, 20.0] };
        let tiled = noise.tiled([2, 2, 1]).unwrap();
        let (mut value, mut dx, mut dy) = (vec![0.0; 6300], vec![0.0; 6300], vec![0.0; 6300]);
        slice.fill(0..90, &mut value);
        slice.fill_slopes(0..90, &mut dx, &mut dy);
        let at = |i: f64, j: f64| tiled.sample3(i * (60.0 / 70.0), j * (0.5 * (60.0 / 45.0)), 4.0 * 1.5);
        for k in [0, 69, 70, 3333, 6299] {
            let (i, j) = ((k % 70) as f64, (k / 70) as f64);
            assert_eq!(value[k], at(i, j), "{k}");
            assert_eq!(value[k], at(i - 70.0, j + 90.0), "across both seams, {k}");
            let east = (at(i + 0.01, j) - at(i - 0.01, j)) * 50.0;
            assert!((dx[k] - east).abs() < 2e-3, "{k}: {} {east}", dx[k]);
        }
    }
}
