//! Means of samples that come some at a time.

/// The mean of what is finite.
#[derive(Debug, Clone, Copy, Default)]
pub struct Mean {
    sum: f64,
    count: usize,
}

impl Mean {
    /// Takes samples; the sum is made in their order.
    pub fn add(&mut self, samples: &[f32]) {
        for sample in samples.iter().filter(|sample| sample.is_finite()) {
            self.sum += f64::from(*sample);
            self.count += 1;
        }
    }

    /// How many there were.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Their mean, NaN of none.
    pub fn mean(&self) -> f64 {
        self.sum / self.count as f64
    }
}
