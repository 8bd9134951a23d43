//! GeoJSON (RFC 7946).

use std::io::{self, Write};

use super::feature_text;
use super::features::{Crs, Definition, FeatureLayer};

pub use super::number::{decimals, number};

/// Writes a layer as a feature collection, one feature per line. `step` is the distance between samples in the unit of
/// the coordinates; coordinates are rounded to at most a thousandth of it, heights to millimetres.
///
/// RFC 7946 requires longitude and latitude (WGS 84); such coordinates are written unchanged. For other systems the
/// file has the `crs` member of GeoJSON 2008, which GDAL and QGIS read, also for local metres (as WKT).
///
/// Fails if `out` fails.
pub fn write(out: &mut dyn Write, layer: &FeatureLayer, crs: Crs, step: f64) -> io::Result<()> {
    write!(out, "{{\"type\":\"FeatureCollection\",\"name\":\"{}\",", layer.name)?;
    let system = match crs.definition() {
        // RFC 7946 implies WGS 84.
        Definition::Epsg(4326, _) | Definition::Unknown { .. } => None,
        Definition::Epsg(code, _) => Some(format!("urn:ogc:def:crs:EPSG::{code}")),
        Definition::Wkt(wkt) => Some(wkt.replace('\\', "\\\\").replace('"', "\\\"")),
    };
    if let Some(system) = system {
        write!(out, "\"crs\":{{\"type\":\"name\",\"properties\":{{\"name\":\"{system}\"}}}},")?;
    }
    writeln!(out, "\"features\":[")?;
    feature_text::write_json(out, layer.fields, &layer.features, layer.geometry.has_z(), decimals(step))?;
    writeln!(out, "\n]}}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::crs::keys::GeoKeys;
    use crate::format::dem::Georeference;
    use crate::format::features::{Feature, Geometry, GeometryType, Value, samples};
    use serde_json::{Value as Json, json};

    fn lines() -> FeatureLayer {
        let line = |points: &[[f64; 3]], values: [Value; 4]| Feature {
            geometry: Geometry::Line(points.to_vec()),
            values: values.to_vec(),
        };
        let mut layer = samples::layer("lines", GeometryType::Line, 0);
        let values = || [Value::Integer(1), Value::Real(250.0), Value::Boolean(true), Value::Null];
        layer.features.push(line(&[[0.0, 0.0, 0.0], [10.25, 30.0, 0.0]], values()));
        layer.features.push(line(&[[0.0, 0.0, 0.0], [10.0, 10.0 / 3.0, 0.0], [0.0; 3]], values()));
        layer
    }

    fn written(mut layer: FeatureLayer, map: Option<&Georeference>) -> Json {
        let mut bytes = Vec::new();
        layer.place(map);
        let step = map.map_or(10.0, |map| 10.0 * map.per_metre[1]);
        write(&mut bytes, &layer, map.map_or(Crs::Local, Crs::Map), step).unwrap();
        serde_json::from_slice(&bytes).unwrap()
    }

    #[test]
    fn local_metres_have_north_up_and_no_place_on_earth() {
        let collection = written(lines(), None);
        assert_eq!(collection["type"], "FeatureCollection");
        assert!(collection["crs"]["properties"]["name"].as_str().unwrap().starts_with("ENGCRS[\"local metres\""));
        let first = &collection["features"][0];
        assert_eq!(first["geometry"]["type"], "LineString");
        assert_eq!(first["geometry"]["coordinates"], json!([[0, 0], [10.25, -30]]));
        assert_eq!(first["properties"], json!({ "id": 1, "area": 250, "closed": true, "ends_in": null }));
        assert_eq!(collection["features"][1]["geometry"]["coordinates"], json!([[0, 0], [10, -3.33], [0, 0]]));
    }

    #[test]
    fn all_types_of_geometries_are_written() {
        let points = written(samples::layer("a", GeometryType::Point, 3), None);
        assert_eq!(points["features"][1]["geometry"], json!({ "type": "Point", "coordinates": [370, -530, 1] }));
        let areas = written(samples::layer("a", GeometryType::MultiPolygon, 1), None);
        let ring = &areas["features"][0]["geometry"]["coordinates"][0][0];
        assert_eq!(*ring, json!([[0, 0], [8, 0], [8, -8], [0, -8], [0, 0]]));
        let lines = written(samples::layer("a", GeometryType::LineZ, 1), None);
        assert_eq!(lines["features"][0]["geometry"]["coordinates"][1], json!([1, -1, 99]));
    }

    #[test]
    fn a_place_has_its_own_coordinates_and_names_their_system() {
        let keys = |directory: &[u16]| Some(GeoKeys { directory: directory.to_vec(), ..GeoKeys::default() });
        let mut map = Georeference {
            origin: [11.0, 47.0],
            per_metre: [1e-5, 9e-6],
            keys: keys(&[1, 1, 0, 2, 1024, 0, 1, 2, 2048, 0, 1, 4326]),
        };
        let collection = written(lines(), Some(&map));
        assert_eq!(collection.get("crs"), None);
        let expect = json!([[11, 47], [11.0001025, 46.99973]]);
        assert_eq!(collection["features"][0]["geometry"]["coordinates"], expect);
        map.keys = keys(&[1, 1, 0, 2, 1024, 0, 1, 1, 3072, 0, 1, 32633]);
        assert_eq!(written(lines(), Some(&map))["crs"]["properties"]["name"], "urn:ogc:def:crs:EPSG::32633");
    }
}
