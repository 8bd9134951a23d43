//! Units of the map's settings.

/// The units of distance by their abbreviations, in metres.
const DISTANCES: [(&str, f64); 6] =
    [("km", 1000.0), ("mi", 1609.344), ("lg", 4828.032), ("vr", 1066.8), ("nmi", 1852.0), ("nlg", 5556.0)];

/// The length of a unit of distance in metres; `None` for a name of the author's own.
pub fn metres(unit: &str) -> Option<f64> {
    DISTANCES.iter().find(|(name, _)| unit.eq_ignore_ascii_case(name)).map(|(_, metres)| *metres)
}

/// The lowest height of land, from 0 to 100.
pub const LAND: f64 = 20.0;

/// Height in metres of a height from 0 to 100: land rises by a power of `exponent`, the sea falls to -950 m, and to
/// -990 m where the height is 0.
pub fn height(height: f64, exponent: f64) -> f64 {
    if height >= LAND {
        libm::pow(height - 18.0, exponent)
    } else if height > 0.0 {
        (50.0 * (height - LAND) / height).max(-990.0)
    } else {
        -990.0
    }
}

/// The range of the exponent of heights.
pub const EXPONENTS: std::ops::RangeInclusive<f64> = 0.5..=2.5;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heights_follow_the_exponent() {
        assert_eq!([20.0, 28.0, 100.0].map(|h| height(h, 2.0)), [4.0, 100.0, 6724.0]);
        assert_eq!([19.0, 10.0, 1.0, 0.5, 0.0].map(|h| height(h, 2.0).round()), [-3.0, -50.0, -950.0, -990.0, -990.0]);
        assert_eq!((metres("KM"), metres("mi"), metres("foot")), (Some(1000.0), Some(1609.344), None));
    }
}
