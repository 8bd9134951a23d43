//! Where eruptions begin.

use crate::grid::Grid;
use crate::random::Random;

/// Sums of the likelihood of vents, from which positions are drawn.
pub(super) struct Vents {
    width: usize,
    /// Sums of the likelihood up to and with each row.
    rows: Vec<f64>,
    likelihood: Vec<f32>,
    center: [f64; 2],
}

impl Vents {
    /// `None` if no sample with a height is likely.
    pub(super) fn new(ground: &Grid, vents: Option<&Grid>) -> Option<Vents> {
        let mut likelihood = vents.map_or_else(|| vec![1.0; ground.data().len()], |vents| vents.data().to_vec());
        for (likelihood, height) in likelihood.iter_mut().zip(ground.data()) {
            let is_possible = height.is_finite() && likelihood.is_finite();
            *likelihood = if is_possible { likelihood.max(0.0) } else { 0.0 };
        }
        let width = ground.width();
        let (mut total, mut moments) = (0.0, [0.0; 2]);
        let mut rows = Vec::with_capacity(ground.height());
        for (j, row) in likelihood.chunks(width.max(1)).enumerate() {
            for (i, likelihood) in row.iter().enumerate() {
                let likelihood = f64::from(*likelihood);
                total += likelihood;
                moments[0] += likelihood * i as f64;
                moments[1] += likelihood * j as f64;
            }
            rows.push(total);
        }
        (total > 0.0).then(|| Vents { width, rows, likelihood, center: moments.map(|moment| moment / total) })
    }

    /// The mean position of vents, in samples.
    pub(super) fn center(&self) -> [f64; 2] {
        self.center
    }

    /// A random position in samples: its row by the sums of rows, then its column by the sums in the row.
    pub(super) fn draw(&self, random: &mut Random) -> [usize; 2] {
        let (down, across) = (random.share(), random.share());
        let total = self.rows.last().copied().unwrap_or(0.0);
        let j = self.rows.partition_point(|sum| *sum <= down * total).min(self.rows.len().saturating_sub(1));
        let row = &self.likelihood[j * self.width..][..self.width];
        let sum: f64 = row.iter().map(|likelihood| f64::from(*likelihood)).sum();
        let mut left = across * sum;
        let mut at = 0;
        for (i, likelihood) in row.iter().enumerate().filter(|(_, likelihood)| **likelihood > 0.0) {
            at = i;
            left -= f64::from(*likelihood);
            if left < 0.0 {
                break;
            }
        }
        [at, j]
    }
}
