//! Contours as GeoJSON (RFC 7946).

use std::io::{self, Write};

use super::levels::is_index;
use super::line::Line;
use crate::format::dem::Georeference;

/// Writes lines as a collection of LineStrings, a line each, with their `elevation` in metres and whether it is an `index`
/// contour, every fifth of `interval`; of levels that were named one by one, none is. Rings end where they begin.
///
/// RFC 7946 wants longitude and latitude (WGS 84). A `map` in those is written so. One in another system is written in its own
/// coordinates, with the `crs` member of the older GeoJSON 2008, which GDAL and QGIS read. Without a map, coordinates are metres
/// east and north of the world's origin (north is up: y is the southing with its sign turned), and `crs` names local metres as
/// WKT, which GDAL reads, too: nowhere on Earth. `cell` is the distance between samples in metres; coordinates are rounded to a thousandth of it or finer.
///
/// # Errors
/// What writing brings.
pub fn write(
    out: &mut dyn Write,
    lines: &[Line],
    cell: f64,
    interval: Option<f64>,
    map: Option<&Georeference>,
) -> io::Result<()> {
    write!(out, "{{\"type\":\"FeatureCollection\",\"name\":\"contours\",")?;
    match map.map(Georeference::epsg) {
        None => write!(out, "{LOCAL}")?,
        // WGS 84, which is what RFC 7946 takes for granted; or a place whose system the file does not tell.
        Some(None | Some(4326)) => {}
        Some(Some(code)) => {
            write!(out, "\"crs\":{{\"type\":\"name\",\"properties\":{{\"name\":\"urn:ogc:def:crs:EPSG::{code}\"}}}},")?
        }
    }
    writeln!(out, "\"features\":[")?;
    let step = map.map_or(cell, |map| cell * map.per_metre[0].min(map.per_metre[1]));
    let decimals = decimals(step);
    let mut text = String::new();
    for (k, line) in lines.iter().enumerate() {
        let index = interval.is_some_and(|interval| is_index(line.elevation, interval));
        text.clear();
        if k > 0 {
            text.push_str(",\n");
        }
        text.push_str("{\"type\":\"Feature\",\"properties\":{\"elevation\":");
        text.push_str(&format!("{},\"index\":{index}}},\"geometry\":{{", line.elevation));
        text.push_str("\"type\":\"LineString\",\"coordinates\":[");
        for (i, [x, y]) in line.path().enumerate() {
            let [east, north] = map.map_or([x, -y], |map| map.at(x, y));
            text.push_str(if i > 0 { ",[" } else { "[" });
            number(&mut text, east, decimals);
            text.push(',');
            number(&mut text, north, decimals);
            text.push(']');
        }
        text.push_str("]}}");
        out.write_all(text.as_bytes())?;
    }
    writeln!(out, "\n]}}")
}

/// Metres that lie nowhere on Earth.
const LOCAL: &str = concat!(
    r#""crs":{"type":"name","properties":{"name":"ENGCRS[\"local metres\",EDATUM[\"origin of the world\"],CS[Cartesian,2],"#,
    r#"AXIS[\"easting\",east],AXIS[\"northing\",north],LENGTHUNIT[\"metre\",1]]"}},"#
);

/// Decimals that tell a thousandth of a step.
pub fn decimals(step: f64) -> usize {
    (3.0 - libm::log10(step).floor()).clamp(0.0, 15.0) as usize
}

/// Adds a number of at most so many decimals, none of them a 0 at the end.
pub fn number(text: &mut String, value: f64, decimals: usize) {
    use std::fmt::Write as _;
    let power = POWERS[decimals.min(POWERS.len() - 1)];
    let scaled = (value * power).round();
    // Whole numbers are much faster to write than fractions.
    if scaled.abs() < 9e15 && decimals < POWERS.len() {
        let (whole, part) = ((scaled.abs() as u64) / power as u64, (scaled.abs() as u64) % power as u64);
        if scaled < 0.0 {
            text.push('-');
        }
        let _ = write!(text, "{whole}");
        if part > 0 {
            let _ = write!(text, ".{part:0decimals$}");
            text.truncate(text.trim_end_matches('0').len());
        }
    } else {
        let _ = write!(text, "{value}");
    }
}

const POWERS: [f64; 16] = [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::dem::GeoKeys;
    use serde_json::Value;

    fn lines() -> Vec<Line> {
        let open = Line { elevation: 250.0, level: 0, closed: false, points: vec![[0.0, 0.0], [10.25, 30.0]] };
        let ring = Line {
            elevation: 252.5,
            level: 1,
            closed: true,
            points: vec![[0.0, 0.0], [0.0, 10.0], [10.0, 10.0 / 3.0]],
        };
        vec![open, ring]
    }

    fn written(map: Option<&Georeference>) -> Value {
        let mut bytes = Vec::new();
        write(&mut bytes, &lines(), 10.0, Some(50.0), map).unwrap();
        serde_json::from_slice(&bytes).unwrap()
    }

    #[test]
    fn local_metres_have_north_up_and_no_place_on_earth() {
        let json = written(None);
        assert_eq!(json["type"], "FeatureCollection");
        assert!(json["crs"]["properties"]["name"].as_str().unwrap().starts_with("ENGCRS[\"local metres\""));
        let first = &json["features"][0];
        assert_eq!(first["geometry"]["type"], "LineString");
        assert_eq!(first["geometry"]["coordinates"], serde_json::json!([[0, 0], [10.25, -30]]));
        assert_eq!(first["properties"], serde_json::json!({ "elevation": 250, "index": true }));
        let ring = &json["features"][1]["geometry"]["coordinates"];
        assert_eq!(*ring, serde_json::json!([[0, 0], [0, -10], [10, -3.33], [0, 0]]));
        assert_eq!(json["features"][1]["properties"]["index"], false);
    }

    #[test]
    fn a_place_has_its_own_coordinates_and_names_their_system() {
        let keys = |directory: &[u16]| Some(GeoKeys { directory: directory.to_vec(), ..GeoKeys::default() });
        let mut map = Georeference {
            origin: [11.0, 47.0],
            per_metre: [1e-5, 9e-6],
            keys: keys(&[1, 1, 0, 2, 1024, 0, 1, 2, 2048, 0, 1, 4326]),
        };
        let json = written(Some(&map));
        assert_eq!(json.get("crs"), None);
        assert_eq!(
            json["features"][0]["geometry"]["coordinates"],
            serde_json::json!([[11, 47], [11.0001025, 46.99973]])
        );
        map.keys = keys(&[1, 1, 0, 2, 1024, 0, 1, 1, 3072, 0, 1, 32633]);
        assert_eq!(written(Some(&map))["crs"]["properties"]["name"], "urn:ogc:def:crs:EPSG::32633");
    }

    #[test]
    fn numbers_are_short_and_exact() {
        for (value, decimals, expect) in [
            (0.0, 2, "0"),
            (-0.001, 2, "0"),
            (12.5, 3, "12.5"),
            (-12.0625, 4, "-12.0625"),
            (1e6 / 3.0, 2, "333333.33"),
            (7.0, 0, "7"),
            (1e300, 3, &format!("{}", 1e300)),
        ] {
            let mut text = String::new();
            number(&mut text, value, decimals);
            assert_eq!(text, expect, "{value}");
        }
        assert_eq!([0.01, 1.0, 30.0, 1e5, 1e-4].map(decimals), [5, 3, 2, 0, 7]);
    }
}
