//! Units of coordinates and heights.

/// The unit of coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Unit {
    /// A length in metres.
    Metres(f64),
    /// Degrees of longitude and latitude.
    Degrees,
    /// Grads of longitude and latitude: 400 in a full circle.
    Grads,
}

impl Unit {
    /// A guess for files that do not state the unit: degrees if all coordinates are valid degrees and cells are smaller
    /// than 0.2, otherwise metres.
    #[must_use]
    pub fn guess(origin: [f64; 2], step: [f64; 2]) -> Unit {
        let degrees = step[0].max(step[1]) < 0.2 && origin[0].abs() <= 180.0 && origin[1].abs() <= 90.0;
        if degrees { Unit::Degrees } else { Unit::Metres(1.0) }
    }

    /// Degrees per unit; `None` for lengths.
    #[must_use]
    pub fn degrees(self) -> Option<f64> {
        match self {
            Unit::Metres(_) => None,
            Unit::Degrees => Some(1.0),
            Unit::Grads => Some(0.9),
        }
    }
}

/// Metres per US survey foot.
pub const US_FOOT: f64 = 1200.0 / 3937.0;

/// EPSG codes of units of length, with metres per unit.
const LENGTHS: &[(u16, f64)] = &[
    (1025, 0.001),
    (1033, 0.01),
    (9001, 1.0),
    (9002, 0.3048),
    (9003, US_FOOT),
    (9005, 0.304_797_265_4),
    (9014, 1.8288),
    (9030, 1852.0),
    (9031, 1.000_013_596_5),
    (9035, 5280.0 * US_FOOT),
    (9036, 1000.0),
    (9037, 0.914_391_796_2),
    (9040, 0.914_398_414_616_028_7),
    (9041, 0.304_799_471_538_676_2),
    (9042, 20.116_765_121_552_632),
    (9070, 0.304_800_833_333_333_35),
    (9080, 0.304_799_510_248_146_94),
    (9081, 0.304_798_41),
    (9082, 0.304_799_6),
    (9083, 0.304_799_5),
    (9084, 0.914_398_530_744_440_8),
    (9093, 1609.344),
    (9094, 0.304_799_710_181_508_8),
    (9095, 0.304_800_749_1),
    (9096, 0.9144),
    (9097, 20.1168),
    (9098, 0.201_168),
    (9099, 0.914_398),
];

/// Metres per unit of length, by its EPSG code.
#[must_use]
pub fn length_of_code(code: u16) -> Option<f64> {
    LENGTHS.iter().find(|row| row.0 == code).map(|row| row.1)
}

/// The EPSG code of a unit of length, by its length in metres.
#[must_use]
pub fn code_of_length(metres: f64) -> Option<u16> {
    LENGTHS.iter().find(|row| (row.1 - metres).abs() <= 1e-9 * metres).map(|row| row.0)
}

/// Metres per unit of length, by a name or symbol that GDAL, PROJ or ESRI uses; `None` if it is not a known length.
#[must_use]
pub fn length_of_name(name: &str) -> Option<f64> {
    let plain: String = name.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect();
    match plain.as_str() {
        "m" | "metre" | "metres" | "meter" | "meters" => Some(1.0),
        "ft" | "foot" | "feet" | "footintl" | "internationalfoot" | "internationalfeet" => Some(0.3048),
        "usft" | "ftus" | "footus" | "ussurveyfoot" | "ussurveyfeet" | "surveyfoot" | "surveyfeet" => Some(US_FOOT),
        "km" | "kilometre" | "kilometer" | "kilometres" | "kilometers" => Some(1000.0),
        "dm" | "decimetre" | "decimeter" | "decimetres" | "decimeters" => Some(0.1),
        "cm" | "centimetre" | "centimeter" | "centimetres" | "centimeters" => Some(0.01),
        "mm" | "millimetre" | "millimeter" | "millimetres" | "millimeters" => Some(0.001),
        "yd" | "yard" | "yards" => Some(0.9144),
        "fathom" | "fathoms" => Some(1.8288),
        _ => None,
    }
}

/// The vertical systems of the EPSG registry that are not in metres, with metres per unit.
const NOT_METRES: &[(u16, f64)] = &[
    (5614, 0.3048),
    (5702, US_FOOT),
    (5754, 0.304_800_749_1),
    (6130, 0.3048),
    (6131, 0.3048),
    (6132, 0.3048),
    (6358, US_FOOT),
    (6359, US_FOOT),
    (6360, US_FOOT),
    (8050, 0.3048),
    (8051, 0.3048),
    (8052, US_FOOT),
    (8053, US_FOOT),
    (8228, 0.3048),
    (8897, 0.3048),
];

/// Metres per unit of the vertical system with this EPSG code.
#[must_use]
pub fn metres_of_vertical(code: u16) -> f64 {
    NOT_METRES.iter().find(|row| row.0 == code).map_or(1.0, |row| row.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_by_name_and_code() {
        for (name, code) in [("m", 9001), ("Metre", 9001), ("ft", 9002), ("US survey foot", 9003), ("us-ft", 9003)] {
            assert_eq!(length_of_name(name), length_of_code(code), "{name}");
        }
        assert_eq!((length_of_name("percent"), length_of_code(9102)), (None, None));
        // A foot and a US survey foot differ by two millionths.
        assert_eq!((code_of_length(0.304_800_609_6), code_of_length(0.3048)), (Some(9003), Some(9002)));
        assert_eq!((Unit::Grads.degrees(), Unit::Metres(1.0).degrees()), (Some(0.9), None));
    }
}
