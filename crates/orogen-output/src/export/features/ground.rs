//! The ground of an area: the number and heights of its samples.

use orogen_io::format::features::{Field, FieldType, Value};

/// The attributes, in the order of [`Ground::values`].
pub const LOWEST: Field = Field { name: "lowest", kind: FieldType::Real, about: "lowest height, m" };
pub const HIGHEST: Field = Field { name: "highest", kind: FieldType::Real, about: "highest height, m" };
pub const MEAN: Field = Field { name: "mean", kind: FieldType::Real, about: "mean height, m" };

/// What is known of the samples of an area.
#[derive(Debug, Clone, Copy)]
pub struct Ground {
    pub count: u64,
    low: f32,
    high: f32,
    sum: f64,
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

    /// The area in m^2, of samples of this cell.
    pub fn area(&self, cell: f64) -> Value {
        Value::Real(self.count as f64 * (cell * cell))
    }

    /// The lowest, the highest and the mean height; without samples, there are none.
    pub fn values(&self) -> [Value; 3] {
        let heights = [f64::from(self.low), f64::from(self.high), self.sum / self.count as f64];
        heights.map(|height| if self.count > 0 { Value::Real(height) } else { Value::Null })
    }
}
