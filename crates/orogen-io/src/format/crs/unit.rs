//! Units of coordinates.

/// The unit of coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Unit {
    /// A length in metres.
    Metres(f64),
    /// Degrees of longitude and latitude.
    Degrees,
}

impl Unit {
    /// A guess for files that do not state the unit: degrees if all numbers are in range and cells are smaller than
    /// 0.2, otherwise metres.
    #[must_use]
    pub fn guess(origin: [f64; 2], step: [f64; 2]) -> Unit {
        let degrees = step[0].max(step[1]) < 0.2 && origin[0].abs() <= 180.0 && origin[1].abs() <= 90.0;
        if degrees { Unit::Degrees } else { Unit::Metres(1.0) }
    }
}
