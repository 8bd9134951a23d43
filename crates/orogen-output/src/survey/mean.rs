//! A running mean.

/// The mean of finite samples.
#[derive(Debug, Clone, Copy, Default)]
pub struct Mean {
    sum: f64,
    count: usize,
}

impl Mean {
    /// Adds samples; the sum is computed in their order.
    pub fn add(&mut self, samples: &[f32]) {
        for sample in samples.iter().filter(|sample| sample.is_finite()) {
            self.sum += f64::from(*sample);
            self.count += 1;
        }
    }

    /// Number of finite samples.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The mean; NaN if there are no samples.
    pub fn mean(&self) -> f64 {
        self.sum / self.count as f64
    }
}
