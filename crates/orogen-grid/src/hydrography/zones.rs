//! Statistics of the heights of a zone.

/// The number and the heights of the samples of a zone.
#[derive(Debug, Clone, Copy)]
pub struct ZoneStats {
    /// The number of samples.
    pub count: u64,
    /// The lowest height in metres.
    pub low: f32,
    /// The highest height in metres.
    pub high: f32,
    /// The sum of all heights in metres.
    pub sum: f64,
}

impl ZoneStats {
    /// No samples.
    pub const EMPTY: ZoneStats = ZoneStats { count: 0, low: f32::INFINITY, high: f32::NEG_INFINITY, sum: 0.0 };

    /// Adds a sample.
    pub fn add(&mut self, height: f32) {
        self.join(&ZoneStats { count: 1, low: height, high: height, sum: f64::from(height) });
    }

    /// Adds the samples of another zone.
    pub fn join(&mut self, other: &ZoneStats) {
        self.count += other.count;
        self.sum += other.sum;
        (self.low, self.high) = (self.low.min(other.low), self.high.max(other.high));
    }
}
