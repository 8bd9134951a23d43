//! Attributes of the ground within an area.

use orogen_grid::hydrography::zones::ZoneStats;
use orogen_io::format::features::{Field, FieldType, Value};

/// The attributes, in the order of [`heights`].
pub const LOWEST: Field = Field { name: "lowest", kind: FieldType::Real, about: "lowest height, m" };
pub const HIGHEST: Field = Field { name: "highest", kind: FieldType::Real, about: "highest height, m" };
pub const MEAN: Field = Field { name: "mean", kind: FieldType::Real, about: "mean height, m" };

/// The area in m^2. `cell` is the distance between samples.
pub fn area(ground: &ZoneStats, cell: f64) -> Value {
    Value::Real(ground.count as f64 * (cell * cell))
}

/// The lowest, the highest and the mean height; null without samples.
pub fn heights(ground: &ZoneStats) -> [Value; 3] {
    let heights = [f64::from(ground.low), f64::from(ground.high), ground.sum / ground.count as f64];
    heights.map(|height| if ground.count > 0 { Value::Real(height) } else { Value::Null })
}
