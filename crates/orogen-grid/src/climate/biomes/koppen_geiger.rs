//! Köppen-Geiger climates.

use super::class::{Class, Climate};

/// The classes.
pub(super) const CLASSES: &[Class] = &[
    Class { code: 0, name: "water", color: [70, 120, 180] },
    Class { code: 1, name: "Af tropical, rainforest", color: [0, 0, 255] },
    Class { code: 2, name: "Am tropical, monsoon", color: [0, 120, 255] },
    Class { code: 3, name: "Aw tropical, savanna", color: [70, 170, 250] },
    Class { code: 4, name: "BWh arid, desert, hot", color: [255, 0, 0] },
    Class { code: 5, name: "BWk arid, desert, cold", color: [255, 150, 150] },
    Class { code: 6, name: "BSh arid, steppe, hot", color: [245, 165, 0] },
    Class { code: 7, name: "BSk arid, steppe, cold", color: [255, 220, 100] },
    Class { code: 8, name: "Csa temperate, dry summer, hot summer", color: [255, 255, 0] },
    Class { code: 9, name: "Csb temperate, dry summer, warm summer", color: [200, 200, 0] },
    Class { code: 10, name: "Csc temperate, dry summer, cold summer", color: [150, 150, 0] },
    Class { code: 11, name: "Cwa temperate, dry winter, hot summer", color: [150, 255, 150] },
    Class { code: 12, name: "Cwb temperate, dry winter, warm summer", color: [100, 200, 100] },
    Class { code: 13, name: "Cwc temperate, dry winter, cold summer", color: [50, 150, 50] },
    Class { code: 14, name: "Cfa temperate, no dry season, hot summer", color: [200, 255, 80] },
    Class { code: 15, name: "Cfb temperate, no dry season, warm summer", color: [100, 255, 80] },
    Class { code: 16, name: "Cfc temperate, no dry season, cold summer", color: [50, 200, 0] },
    Class { code: 17, name: "Dsa cold, dry summer, hot summer", color: [255, 0, 255] },
    Class { code: 18, name: "Dsb cold, dry summer, warm summer", color: [200, 0, 200] },
    Class { code: 19, name: "Dsc cold, dry summer, cold summer", color: [150, 50, 150] },
    Class { code: 20, name: "Dsd cold, dry summer, very cold winter", color: [150, 100, 150] },
    Class { code: 21, name: "Dwa cold, dry winter, hot summer", color: [170, 175, 255] },
    Class { code: 22, name: "Dwb cold, dry winter, warm summer", color: [90, 120, 220] },
    Class { code: 23, name: "Dwc cold, dry winter, cold summer", color: [75, 80, 180] },
    Class { code: 24, name: "Dwd cold, dry winter, very cold winter", color: [50, 0, 135] },
    Class { code: 25, name: "Dfa cold, no dry season, hot summer", color: [0, 255, 255] },
    Class { code: 26, name: "Dfb cold, no dry season, warm summer", color: [55, 200, 255] },
    Class { code: 27, name: "Dfc cold, no dry season, cold summer", color: [0, 125, 125] },
    Class { code: 28, name: "Dfd cold, no dry season, very cold winter", color: [0, 70, 95] },
    Class { code: 29, name: "ET polar, tundra", color: [178, 178, 178] },
    Class { code: 30, name: "EF polar, frost", color: [102, 102, 102] },
];

/// The first codes of the groups.
const TROPICAL: u8 = 1;
const ARID: u8 = 4;
const TEMPERATE: u8 = 8;
const COLD: u8 = 17;
const POLAR: u8 = 29;

/// The six months around the warmest one. The other six are winter.
const SUMMER: [usize; 6] = [10, 11, 0, 1, 2, 3];

/// The class of a climate, by the criteria of Peel, Finlayson and McMahon (2007).
pub(super) fn code(climate: &Climate) -> u8 {
    let year = &climate.year;
    let rain = climate.rain_of_months();
    let summer = SUMMER.map(|month| rain[month]);
    let winter = SUMMER.map(|month| rain[(month + 6) % 12]);
    let threshold = 2.0 * year.mean + extra(climate.rain, summer.iter().sum(), winter.iter().sum());
    if climate.rain < 10.0 * threshold {
        let steppe = u8::from(climate.rain >= 5.0 * threshold);
        return ARID + 2 * steppe + u8::from(year.mean < 18.0);
    }
    if year.coldest() >= 18.0 {
        let driest = least(&rain);
        return TROPICAL
            + match driest {
                driest if driest >= 60.0 => 0,
                driest if driest >= 100.0 - climate.rain / 25.0 => 1,
                _ => 2,
            };
    }
    if year.warmest() <= 10.0 {
        return POLAR + u8::from(year.warmest() <= 0.0);
    }
    // 0 for dry summers, 1 for dry winters, 2 without a dry season.
    let (dry_summer, dry_winter) = (least(&summer), least(&winter));
    let season = match () {
        () if dry_summer < 40.0 && dry_summer < most(&winter) / 3.0 => 0,
        () if dry_winter < most(&summer) / 10.0 => 1,
        () => 2,
    };
    // 0 for hot summers, 1 for warm summers, 2 for cold summers.
    let warm_months = year.months().iter().filter(|month| **month >= 10.0).count();
    let warmth = match year.warmest() {
        warmest if warmest >= 22.0 => 0,
        _ if warm_months >= 4 => 1,
        _ => 2,
    };
    match year.coldest() {
        coldest if coldest > 0.0 => TEMPERATE + 3 * season + warmth,
        // A winter below -38 degrees C takes precedence over a cold summer.
        coldest if coldest < -38.0 && warmth == 2 => COLD + 4 * season + 3,
        _ => COLD + 4 * season + warmth,
    }
}

/// Difference between the aridity threshold and twice the mean temperature: 0 if at least seven tenths of the rain fall
/// in winter, 28 if they fall in summer, otherwise 14.
fn extra(rain: f64, summer: f64, winter: f64) -> f64 {
    match () {
        () if winter >= 0.7 * rain => 0.0,
        () if summer >= 0.7 * rain => 28.0,
        () => 14.0,
    }
}

fn least(months: &[f64]) -> f64 {
    months.iter().copied().fold(f64::INFINITY, f64::min)
}

fn most(months: &[f64]) -> f64 {
    months.iter().copied().fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::climate::year::Year;

    #[test]
    fn places_have_their_climates() {
        for (place, mean, range, rain, seasonality, expected) in [
            ("Singapore", 27.8, 0.9, 2165.0, 0.0, "Af"),
            ("Miami", 24.9, 4.5, 1570.0, 0.6, "Am"),
            ("Darwin", 27.6, 2.5, 1730.0, 1.0, "Aw"),
            ("Cairo", 22.2, 7.5, 18.0, -0.8, "BWh"),
            ("Turpan", 14.4, 20.0, 16.0, 0.5, "BWk"),
            ("Denver", 10.4, 12.0, 363.0, 0.7, "BSk"),
            ("Rome", 15.7, 8.5, 798.0, -0.6, "Csa"),
            ("San Francisco", 14.1, 3.8, 581.0, -0.9, "Csb"),
            ("Hong Kong", 23.5, 6.4, 2431.0, 0.95, "Cwa"),
            ("Atlanta", 17.0, 10.0, 1263.0, 0.0, "Cfa"),
            ("London", 11.3, 6.7, 615.0, 0.0, "Cfb"),
            ("Chicago", 10.5, 14.0, 938.0, 0.3, "Dfa"),
            ("Moscow", 6.3, 13.0, 713.0, 0.2, "Dfb"),
            ("Irkutsk", 1.4, 18.4, 472.0, 0.95, "Dwb"),
            ("Yakutsk", -8.0, 29.0, 237.0, 0.6, "Dfc"),
            ("Verkhoyansk", -14.5, 31.0, 181.0, 0.6, "Dfd"),
            ("Utqiagvik", -10.2, 15.0, 137.0, 0.4, "ET"),
            ("Vostok", -55.0, 18.0, 20.0, 0.0, "EF"),
        ] {
            let climate = Climate { year: Year { mean, range }, rain, seasonality };
            let name = CLASSES[usize::from(code(&climate))].name;
            assert_eq!(name.split(' ').next(), Some(expected), "{place}: {name}");
        }
    }
}
