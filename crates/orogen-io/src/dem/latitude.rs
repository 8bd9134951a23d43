//! The latitude of a position on a map.

use crate::format::crs::unit::Unit;
use crate::format::dem::Georeference;

/// The semi-major axis in metres, and the square of the eccentricity (WGS 84).
const EQUATOR: f64 = 6_378_137.0;
const SQUARED: f64 = 0.006_694_379_990_14;

/// Latitude in degrees north at a position in metres of the lattice; `None` unless its map is in degrees or in a UTM
/// zone (WGS 84, NAD 83 or NAD 27; the datum changes the latitude by less than 0.001 degrees).
#[must_use]
pub fn latitude(map: &Georeference, x: f64, y: f64) -> Option<f64> {
    let [east, north] = map.at(x, y);
    if let Some(degrees) = map.unit().and_then(Unit::degrees) {
        let north = north * degrees;
        return (-90.0..=90.0).contains(&north).then_some(north);
    }
    let northing = match map.epsg()? {
        32601..=32660 | 26901..=26923 | 26701..=26722 => north,
        32701..=32760 => north - 10_000_000.0,
        _ => return None,
    };
    Some(from_utm(east, northing))
}

/// The series of the inverse transverse Mercator projection (Snyder, "Map projections: a working manual", 1987, p. 63).
fn from_utm(east: f64, north: f64) -> f64 {
    let e2 = SQUARED;
    let mu = north / 0.9996 / (EQUATOR * (1.0 - e2 * (0.25 + e2 * (3.0 / 64.0 + e2 * 5.0 / 256.0))));
    let root = (1.0 - e2).sqrt();
    let e1 = (1.0 - root) / (1.0 + root);
    let foot = mu
        + e1 * (1.5 - e1 * e1 * 27.0 / 32.0) * libm::sin(2.0 * mu)
        + e1 * e1 * (21.0 / 16.0) * libm::sin(4.0 * mu)
        + e1 * e1 * e1 * (151.0 / 96.0) * libm::sin(6.0 * mu);
    let (sine, cosine) = libm::sincos(foot);
    let bent = 1.0 - e2 * sine * sine;
    let (across, along) = (EQUATOR / bent.sqrt(), EQUATOR * (1.0 - e2) / (bent * bent.sqrt()));
    let d = (east - 500_000.0) / (across * 0.9996);
    (foot - across * sine / cosine / along * d * d / 2.0).to_degrees()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::crs::keys::GeoKeys;

    fn map(origin: [f64; 2], per_metre: f64, model: u16, epsg: u16) -> Georeference {
        let key = if model == 2 { 2048 } else { 3072 };
        let directory = vec![1, 1, 0, 2, 1024, 0, 1, model, key, 0, 1, epsg];
        let keys = GeoKeys { directory, ..GeoKeys::default() };
        Georeference { origin, per_metre: [per_metre; 2], keys: Some(keys) }
    }

    #[test]
    fn zones_and_degrees_tell_the_latitude() {
        // Expected values are results of PROJ for these positions.
        for (origin, epsg, expect) in [
            ([500_000.0, 5_000_000.0], 32632, 45.153_477),
            ([700_000.0, 4_100_000.0], 32612, 37.024_915),
            ([400_000.0, 6_300_000.0], 32719, -33.434_729),
        ] {
            let got = latitude(&map(origin, 1.0, 1, epsg), 0.0, 0.0).unwrap();
            assert!((got - expect).abs() < 1e-4, "{epsg}: {got} {expect}");
        }
        let got = latitude(&map([7.0, 46.0], 1e-5, 2, 4326), 0.0, 1000.0).unwrap();
        assert!((got - 45.99).abs() < 1e-9);
        assert_eq!(latitude(&map([0.0, 0.0], 1.0, 1, 3857), 0.0, 0.0), None);
    }
}
