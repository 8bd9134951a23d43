//! Whittaker's biomes.

use super::class::{Class, Climate};

/// The classes.
pub(super) const CLASSES: &[Class] = &[
    Class { code: 0, name: "water", color: [70, 120, 180] },
    Class { code: 1, name: "tundra", color: [178, 190, 170] },
    Class { code: 2, name: "boreal forest", color: [82, 122, 92] },
    Class { code: 3, name: "woodland and shrubland", color: [176, 158, 92] },
    Class { code: 4, name: "temperate grassland and cold desert", color: [216, 204, 142] },
    Class { code: 5, name: "temperate seasonal forest", color: [122, 164, 84] },
    Class { code: 6, name: "temperate rain forest", color: [56, 130, 96] },
    Class { code: 7, name: "subtropical desert", color: [234, 194, 128] },
    Class { code: 8, name: "tropical seasonal forest and savanna", color: [168, 170, 62] },
    Class { code: 9, name: "tropical rain forest", color: [30, 102, 44] },
    Class { code: 10, name: "ice", color: [244, 248, 252] },
];

const TUNDRA: u8 = 1;
const BOREAL_FOREST: u8 = 2;
const WOODLAND: u8 = 3;
const GRASSLAND: u8 = 4;
const SEASONAL_FOREST: u8 = 5;
const TEMPERATE_RAIN_FOREST: u8 = 6;
const DESERT: u8 = 7;
const SAVANNA: u8 = 8;
const RAIN_FOREST: u8 = 9;
const ICE: u8 = 10;

/// Mean temperatures in degrees C that separate boreal from temperate forest, and temperate from tropical biomes.
const BOREAL: f64 = 3.0;
const TROPICAL: f64 = 19.0;

/// The class of a climate, with straight lines along the borders of the diagram.
pub(super) fn code(climate: &Climate) -> u8 {
    let (mean, rain) = (climate.year.mean, climate.rain);
    if climate.year.warmest() < 0.0 {
        return ICE;
    }
    if mean >= TROPICAL {
        return match rain {
            rain if rain < line(mean, [24.0, 670.0], if mean < 24.0 { 28.0 } else { 45.0 }) => DESERT,
            rain if rain < line(mean, [24.0, 2480.0], if mean < 24.0 { 26.0 } else { 70.0 }) => SAVANNA,
            _ => RAIN_FOREST,
        };
    }
    // In wet climates, tundra extends to milder temperatures.
    if mean < line(rain, [0.0, -6.9], 0.0027).min(-4.0) {
        return TUNDRA;
    }
    let (dry, open) = (line(mean, [0.0, 224.0], 17.2), line(mean, [0.0, 395.0], if mean < 0.0 { 30.0 } else { 46.0 }));
    match rain {
        rain if rain < dry => GRASSLAND,
        rain if rain < open => WOODLAND,
        _ if mean < BOREAL => BOREAL_FOREST,
        rain if rain < line(mean, [10.0, 2120.0], if mean < 10.0 { 60.0 } else { 25.0 }) => SEASONAL_FOREST,
        _ => TEMPERATE_RAIN_FOREST,
    }
}

/// The line through a point with a slope.
fn line(x: f64, [x0, y0]: [f64; 2], slope: f64) -> f64 {
    y0 + slope * (x - x0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::climate::year::Year;

    #[test]
    fn places_have_their_biomes() {
        for (place, mean, range, rain, expected) in [
            ("Utqiagvik", -10.2, 15.0, 137.0, TUNDRA),
            ("Fairbanks", -2.4, 19.0, 297.0, WOODLAND),
            ("Arkhangelsk", 1.3, 15.0, 607.0, BOREAL_FOREST),
            ("Denver", 10.4, 12.0, 363.0, GRASSLAND),
            ("Los Angeles", 17.8, 4.5, 377.0, GRASSLAND),
            ("Athens", 18.0, 9.5, 600.0, WOODLAND),
            ("Munich", 9.7, 10.0, 944.0, SEASONAL_FOREST),
            ("Forks", 9.8, 5.5, 3040.0, TEMPERATE_RAIN_FOREST),
            ("Cairo", 22.2, 7.5, 18.0, DESERT),
            ("Darwin", 27.6, 2.5, 1730.0, SAVANNA),
            ("Singapore", 27.8, 0.9, 3165.0, RAIN_FOREST),
            ("Vostok", -55.0, 18.0, 20.0, ICE),
        ] {
            let climate = Climate { year: Year { mean, range }, rain, seasonality: 0.0 };
            assert_eq!(code(&climate), expected, "{place}");
        }
    }
}
