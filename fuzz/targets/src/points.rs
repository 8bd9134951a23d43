//! Points of CSV and GeoJSON: any text has points with coordinates, or is refused with a message.

use orogen::io::format::NamedPoints;

/// Runs the target on an input; one that is no text is skipped.
pub fn run(input: &[u8]) {
    let Ok(text) = std::str::from_utf8(input) else { return };
    for found in [NamedPoints::from_csv(text), NamedPoints::from_geojson(text)].into_iter().flatten() {
        for point in found.points {
            assert!(point.at.iter().all(|at| at.is_finite()), "{point:?}");
            assert!(point.name.is_none_or(|name| !name.is_empty()));
        }
    }
}
