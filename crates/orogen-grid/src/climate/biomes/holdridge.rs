//! Holdridge's life zones.

use super::class::{Class, Climate};

/// The classes: from cold to warm, and within a belt from dry to wet.
pub(super) const CLASSES: &[Class] = &[
    Class { code: 0, name: "water", color: [70, 120, 180] },
    Class { code: 1, name: "polar desert", color: [244, 248, 252] },
    Class { code: 2, name: "dry tundra", color: [206, 208, 200] },
    Class { code: 3, name: "moist tundra", color: [170, 186, 178] },
    Class { code: 4, name: "wet tundra", color: [128, 164, 158] },
    Class { code: 5, name: "rain tundra", color: [92, 142, 148] },
    Class { code: 6, name: "boreal desert", color: [196, 190, 172] },
    Class { code: 7, name: "boreal dry scrub", color: [153, 165, 140] },
    Class { code: 8, name: "boreal moist forest", color: [110, 140, 108] },
    Class { code: 9, name: "boreal wet forest", color: [75, 119, 110] },
    Class { code: 10, name: "boreal rain forest", color: [40, 98, 112] },
    Class { code: 11, name: "cool temperate desert", color: [216, 198, 160] },
    Class { code: 12, name: "cool temperate desert scrub", color: [185, 184, 135] },
    Class { code: 13, name: "cool temperate steppe", color: [154, 171, 110] },
    Class { code: 14, name: "cool temperate moist forest", color: [116, 151, 97] },
    Class { code: 15, name: "cool temperate wet forest", color: [73, 126, 94] },
    Class { code: 16, name: "cool temperate rain forest", color: [30, 100, 92] },
    Class { code: 17, name: "warm temperate desert", color: [228, 198, 140] },
    Class { code: 18, name: "warm temperate desert scrub", color: [202, 189, 121] },
    Class { code: 19, name: "warm temperate thorn steppe", color: [176, 181, 103] },
    Class { code: 20, name: "warm temperate dry forest", color: [150, 172, 84] },
    Class { code: 21, name: "warm temperate moist forest", color: [107, 147, 80] },
    Class { code: 22, name: "warm temperate wet forest", color: [63, 123, 76] },
    Class { code: 23, name: "warm temperate rain forest", color: [20, 98, 72] },
    Class { code: 24, name: "subtropical desert", color: [232, 192, 124] },
    Class { code: 25, name: "subtropical desert scrub", color: [207, 187, 106] },
    Class { code: 26, name: "subtropical thorn woodland", color: [183, 183, 88] },
    Class { code: 27, name: "subtropical dry forest", color: [158, 178, 70] },
    Class { code: 28, name: "subtropical moist forest", color: [110, 151, 65] },
    Class { code: 29, name: "subtropical wet forest", color: [62, 123, 61] },
    Class { code: 30, name: "subtropical rain forest", color: [14, 96, 56] },
    Class { code: 31, name: "tropical desert", color: [238, 184, 108] },
    Class { code: 32, name: "tropical desert scrub", color: [217, 183, 92] },
    Class { code: 33, name: "tropical thorn woodland", color: [196, 183, 76] },
    Class { code: 34, name: "tropical very dry forest", color: [175, 182, 60] },
    Class { code: 35, name: "tropical dry forest", color: [141, 169, 50] },
    Class { code: 36, name: "tropical moist forest", color: [96, 143, 47] },
    Class { code: 37, name: "tropical wet forest", color: [51, 118, 43] },
    Class { code: 38, name: "tropical rain forest", color: [6, 92, 40] },
];

/// The code of the polar desert.
const POLAR_DESERT: u8 = 1;

/// The first code of each temperature belt and the number of its zones: subpolar, boreal, cool temperate, warm
/// temperate, tropical. The subtropical zones follow those of the warm temperate belt.
const BELTS: [(u8, i32); 5] = [(2, 4), (6, 5), (11, 6), (17, 7), (31, 8)];

/// Index of the belt that the frost line divides.
const WARM: usize = 3;

/// Biotemperature of the frost line, in degrees C: the logarithmic mean of 12 and 24.
const FROST_LINE: f64 = 16.970_562_748_477_14;

/// Lowest biotemperature of the subpolar belt, in degrees C, and half the least rain of its second zone, in mm.
const COLDEST: f64 = 1.5;
const DRIEST: f64 = 62.5;

/// The class of a climate: the hexagon that contains its biotemperature, its rain and their ratio, in logarithms.
pub(super) fn code(climate: &Climate) -> u8 {
    let biotemperature = climate.year.biotemperature();
    if biotemperature <= 0.0 {
        return POLAR_DESERT;
    }
    let (belt, zone) =
        hexagon(libm::log2(biotemperature / COLDEST) - 0.5, libm::log2(climate.rain.max(1e-3) / DRIEST) - 0.5);
    let Some(index) = usize::try_from(belt).ok() else { return POLAR_DESERT };
    let index = index.min(BELTS.len() - 1);
    let (first, count) = BELTS[index];
    let zone = zone.clamp(0, count - 1) as u8;
    match index == WARM && biotemperature >= FROST_LINE {
        true => first + count as u8 + zone,
        false => first + zone,
    }
}

/// The column and row of the hexagon that contains a point. Hexagons are regular if the axes of columns, of rows and of
/// their difference are at 120 degrees to each other.
fn hexagon(column: f64, row: f64) -> (i32, i32) {
    let axes = [column, -row, row - column];
    let [mut q, mut r, s] = axes.map(f64::round);
    let [off_q, off_r, off_s] = [(q - axes[0]).abs(), (r - axes[1]).abs(), (s - axes[2]).abs()];
    // The three numbers of a hexagon have the sum 0, so the one that was rounded most follows from the others.
    if off_q > off_r && off_q > off_s {
        q = -r - s;
    } else if off_r > off_s {
        r = -q - s;
    }
    (q as i32, -r as i32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::climate::year::Year;

    fn name(mean: f64, range: f64, rain: f64) -> &'static str {
        let climate = Climate { year: Year { mean, range }, rain, seasonality: 0.0 };
        CLASSES[usize::from(code(&climate))].name
    }

    #[test]
    fn the_middles_of_hexagons_have_their_names() {
        // Powers of two times the square root of two: the middle of a belt and of a range of rain.
        let middle = std::f64::consts::SQRT_2;
        assert_eq!(name(1.5 * middle, 0.0, 62.5 * middle), "dry tundra");
        assert_eq!(name(3.0 * middle, 0.0, 250.0 * middle), "boreal moist forest");
        assert_eq!(name(6.0 * middle, 0.0, 250.0 * middle), "cool temperate steppe");
        assert_eq!(name(6.0 * middle, 0.0, 500.0 * middle), "cool temperate moist forest");
        assert_eq!(name(14.0, 0.0, 500.0 * middle), "warm temperate dry forest");
        assert_eq!(name(20.0, 0.0, 1000.0 * middle), "subtropical moist forest");
        assert_eq!(name(27.0, 0.0, 2000.0 * middle), "tropical moist forest");
        assert_eq!(name(27.0, 0.0, 9000.0), "tropical rain forest");
        assert_eq!(name(27.0, 0.0, 0.0), "tropical desert");
        assert_eq!(name(0.4, 0.0, 300.0), "polar desert");
        assert_eq!(name(-30.0, 10.0, 300.0), "polar desert");
    }

    #[test]
    fn a_hexagon_has_the_points_nearest_to_its_middle() {
        for k in 0..40_000 {
            let (column, row) = (f64::from(k % 200) * 0.03 - 2.0, f64::from(k / 200) * 0.03 - 2.0);
            let (q, r) = hexagon(column, row);
            let distance = |q: i32, r: i32| {
                let (a, b) = (column - f64::from(q), row - f64::from(r));
                a * a + b * b - a * b
            };
            let around = (-1..=1).flat_map(|dq| (-1..=1).map(move |dr| (q + dq, r + dr)));
            assert!(around.map(|(q, r)| distance(q, r)).all(|other| distance(q, r) <= other + 1e-9), "{column} {row}");
        }
    }
}
