//! The ground of an area: the number and heights of its samples.

/// What is known of the samples of an area.
#[derive(Debug, Clone, Copy)]
pub struct Ground {
    /// The number of samples.
    pub count: u64,
    /// The lowest height in metres.
    pub low: f32,
    /// The highest.
    pub high: f32,
    /// The sum of all heights.
    pub sum: f64,
}

impl Ground {
    /// No samples.
    pub const EMPTY: Ground = Ground { count: 0, low: f32::INFINITY, high: f32::NEG_INFINITY, sum: 0.0 };

    /// Adds a sample.
    pub fn add(&mut self, height: f32) {
        self.join(&Ground { count: 1, low: height, high: height, sum: f64::from(height) });
    }

    /// Adds the samples of another area.
    pub fn join(&mut self, other: &Ground) {
        self.count += other.count;
        self.sum += other.sum;
        (self.low, self.high) = (self.low.min(other.low), self.high.max(other.high));
    }
}
