//! Potential evapotranspiration and humidity.

use super::year::Year;

/// Potential evapotranspiration per degree of biotemperature, in mm per year (Holdridge 1967).
pub const PER_DEGREE: f64 = 58.93;

/// Maximum of [`humidity`].
pub const MAX_HUMIDITY: f64 = 100.0;

/// Potential evapotranspiration in mm per year: the water that plants and soil would evaporate if it were available. It
/// is 58.93 times the [biotemperature](Year::biotemperature) (Holdridge 1967).
#[must_use]
pub fn potential(year: &Year) -> f64 {
    PER_DEGREE * year.biotemperature()
}

/// The aridity index of UNEP (1992): rain over potential evapotranspiration, both in mm per year, at most 100. The
/// climate is hyperarid below 0.05, arid below 0.2, semi-arid below 0.5, dry subhumid below 0.65, and humid from there
/// on.
#[must_use]
pub fn humidity(rain: f64, potential: f64) -> f64 {
    let rain = rain.max(0.0);
    // This includes places without evaporation. 0 / 0 counts as humid, because no water evaporates.
    if rain >= MAX_HUMIDITY * potential { MAX_HUMIDITY } else { rain / potential }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_grows_with_warmth_and_needs_no_rain() {
        let year = |mean: f64| Year { mean, range: 8.0 };
        assert!((potential(&year(12.0)) - 707.16).abs() < 1e-9);
        assert_eq!(potential(&year(-9.0)), 0.0);
        assert!(potential(&year(20.0)) < potential(&year(24.0)));
        assert_eq!([humidity(500.0, 1000.0), humidity(500.0, 0.0), humidity(0.0, 0.0)], [0.5, 100.0, 100.0]);
        assert_eq!([humidity(-3.0, 800.0), humidity(-3.0, 0.0)], [0.0, 100.0]);
    }
}
