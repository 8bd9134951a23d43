//! What coordinates are measured in.

/// The unit of coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Unit {
    /// So many metres.
    Metres(f64),
    /// Degrees of longitude and latitude.
    Degrees,
}

impl Unit {
    /// What coordinates are probably measured in whose file does not say: degrees, if all numbers could be and cells are under 0.2; else metres.
    pub fn guess(origin: [f64; 2], step: [f64; 2]) -> Unit {
        let degrees = step[0].max(step[1]) < 0.2 && origin[0].abs() <= 180.0 && origin[1].abs() <= 90.0;
        if degrees { Unit::Degrees } else { Unit::Metres(1.0) }
    }
}
