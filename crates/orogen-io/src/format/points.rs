//! Named points and lines from CSV and GeoJSON.

use std::path::Path;

use orogen_grid::error::Result;
use orogen_grid::words::bytes;
use serde_json::Value;

use super::crs::registry::Crs;
use super::dem::{Georeference, refused};
use crate::open;

/// Maximum length of a file, in bytes.
const MAX_LENGTH: u64 = 4 << 20;

/// A point of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedPoint {
    /// The name, if it has one.
    pub name: Option<String>,
    /// The kind, such as `summit`, if it is stated.
    pub kind: Option<String>,
    /// The height in metres, if it is stated.
    pub height: Option<f64>,
    /// East and north, or longitude and latitude.
    pub at: [f64; 2],
}

/// A line of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedLine {
    /// The name, if it has one.
    pub name: Option<String>,
    /// The kind, such as `river`, if it is stated.
    pub kind: Option<String>,
    /// Positions: east and north, or longitude and latitude.
    pub points: Vec<[f64; 2]>,
}

/// The points and lines of a file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct NamedPoints {
    /// The points, in the order of the file.
    pub points: Vec<NamedPoint>,
    /// The lines, in the order of the file; only GeoJSON has any.
    pub lines: Vec<NamedLine>,
    /// The EPSG code of the coordinate system, if the file states it.
    pub epsg: Option<u16>,
}

/// The names of columns, in lower case.
const EAST: &[&str] = &["x", "e", "east", "easting", "lon", "long", "longitude"];
const NORTH: &[&str] = &["y", "n", "north", "northing", "lat", "latitude"];
const NAME: &[&str] = &["name", "label", "title", "station", "id"];
const KIND: &[&str] = &["kind", "type", "class", "natural", "waterway", "place"];
const HEIGHT: &[&str] = &["height", "elevation", "ele", "z"];

impl NamedPoints {
    /// Reads at most `most` points and lines of a file. Its extension determines the format: .csv, .txt or .tsv,
    /// .geojson or .json.
    ///
    /// # Errors
    /// If the file cannot be read, is not valid, has no points, or has too many.
    pub fn read(path: &Path, most: usize) -> Result<NamedPoints> {
        let name = path.display().to_string();
        let extension = path.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase());
        let parse = match extension.as_deref() {
            Some("csv" | "txt" | "tsv") => NamedPoints::from_csv,
            Some("geojson" | "json") => NamedPoints::from_geojson,
            _ => return Err(refused(&name, "points are read from .csv and .geojson; save them as one of these")),
        };
        let Some(content) = open::bytes(path, "read", MAX_LENGTH)? else {
            return Err(refused(
                &name,
                format!("it has more than {}, the limit of a file of points", bytes(MAX_LENGTH)),
            ));
        };
        let text = String::from_utf8(content).map_err(|_| refused(&name, "it is not text in UTF-8"))?;
        let found = parse(text.trim_start_matches('\u{feff}')).map_err(|why| refused(&name, why))?;
        match found.points.len() + found.lines.len() {
            0 => Err(refused(&name, "it has no points")),
            count if count > most => Err(refused(&name, format!("it has {count} points, and at most {most} are read"))),
            _ => Ok(found),
        }
    }

    /// [Reads](NamedPoints::read) points that must be in the coordinate system of a map, if both systems are known.
    /// `of` says what the map belongs to, for messages.
    ///
    /// # Errors
    /// The errors of [`read`](NamedPoints::read), or if the points are in another coordinate system.
    pub fn read_on(path: &Path, map: Option<&Georeference>, of: &str, most: usize) -> Result<NamedPoints> {
        let found = NamedPoints::read(path, most)?;
        match (found.epsg, map.and_then(Georeference::epsg)) {
            (Some(own), Some(epsg)) if own != epsg => {
                let name = path.display().to_string();
                let why = format!(
                    "its points are in EPSG:{own}, and {of} are in EPSG:{epsg}; convert them first, such as with `ogr2ogr -t_srs EPSG:{epsg} \
                     points.geojson FILE`"
                );
                Err(refused(&name, why))
            }
            _ => Ok(found),
        }
    }

    /// Reads the points of comma-separated values (RFC 4180), or of values separated by semicolons or tabs. The first
    /// line names the columns; without names they are east, north and, if there is a third one, the name.
    ///
    /// # Errors
    /// A message with the line that is not valid.
    pub fn from_csv(text: &str) -> std::result::Result<NamedPoints, String> {
        let first = text.lines().find(|line| !line.trim().is_empty()).unwrap_or_default();
        let separator = [';', '\t', ','].into_iter().find(|separator| first.contains(*separator)).unwrap_or(',');
        let number = |text: &str| {
            let text = text.trim();
            // Where semicolons separate values, a comma may be the decimal point.
            let text = if separator == ';' { text.replace(',', ".") } else { text.into() };
            text.parse::<f64>().ok().filter(|number| number.is_finite())
        };
        let mut columns: Option<Columns> = None;
        let mut points = Vec::new();
        for (line, record) in records(text, separator)? {
            let Some(known) = columns else {
                let is_number = |k: usize| record.get(k).is_some_and(|text| number(text).is_some());
                if is_number(0) && is_number(1) {
                    let known = Columns { east: 0, north: 1, name: Some(2), kind: None, height: None };
                    columns = Some(known);
                    points.push(point(&record, known, number, line)?);
                    continue;
                }
                let named = |names: &[&str]| {
                    names.iter().find_map(|name| record.iter().position(|text| text.trim().eq_ignore_ascii_case(name)))
                };
                let (Some(east), Some(north)) = (named(EAST), named(NORTH)) else {
                    return Err(format!(
                        "line {line} must name the columns with the coordinates: `x` and `y`, `easting` and `northing`, or `lon` and `lat`"
                    ));
                };
                columns = Some(Columns { east, north, name: named(NAME), kind: named(KIND), height: named(HEIGHT) });
                continue;
            };
            points.push(point(&record, known, number, line)?);
        }
        Ok(NamedPoints { points, ..NamedPoints::default() })
    }

    /// Reads the points and lines of GeoJSON: `Point`, `MultiPoint`, `LineString` and `MultiLineString`. The name is
    /// the property `name`, `label`, `title`, `station` or `id`; the kind is `kind`, `type`, `class`, `natural`,
    /// `waterway` or `place`; the height is `height`, `elevation`, `ele` or `z`.
    ///
    /// # Errors
    /// A message if it is not valid.
    pub fn from_geojson(text: &str) -> std::result::Result<NamedPoints, String> {
        let value: Value = serde_json::from_str(text).map_err(|cause| format!("it is not valid GeoJSON ({cause})"))?;
        if value["type"].as_str().is_none() {
            return Err("it is not GeoJSON: its `type` is missing".into());
        }
        let epsg = match value["crs"]["properties"]["name"].as_str() {
            None | Some("urn:ogc:def:crs:OGC:1.3:CRS84") => None,
            Some(name) => name.parse::<Crs>().ok().map(|crs| crs.code()),
        };
        let mut found = NamedPoints { epsg, ..NamedPoints::default() };
        let alone = std::slice::from_ref(&value);
        for feature in value["features"].as_array().map_or(alone, Vec::as_slice) {
            let geometry = if feature["geometry"].is_object() { &feature["geometry"] } else { feature };
            let coordinates = &geometry["coordinates"];
            let properties = feature["properties"].as_object();
            let property = |names: &[&str]| {
                let of = |known: &&str| {
                    properties?
                        .iter()
                        .find(|(key, _)| key.eq_ignore_ascii_case(known))
                        .and_then(|(_, value)| text_of(value))
                };
                names.iter().find_map(of)
            };
            let (name, kind) = (property(NAME), property(KIND));
            let alone = std::slice::from_ref(coordinates);
            let lines = match geometry["type"].as_str() {
                Some("LineString") => alone,
                Some("MultiLineString") => coordinates.as_array().map_or(&[][..], Vec::as_slice),
                _ => &[][..],
            };
            for line in lines {
                let points = line.as_array().map_or(&[][..], Vec::as_slice).iter().map(position);
                let points = points.collect::<std::result::Result<Vec<[f64; 2]>, String>>()?;
                found.lines.push(NamedLine { name: name.clone(), kind: kind.clone(), points });
            }
            let places = match geometry["type"].as_str() {
                Some("Point") => alone,
                Some("MultiPoint") => coordinates.as_array().map_or(&[][..], Vec::as_slice),
                _ => continue,
            };
            let height = property(HEIGHT).and_then(|text| text.parse().ok()).filter(|height: &f64| height.is_finite());
            for place in places {
                let at = position(place)?;
                found.points.push(NamedPoint { name: name.clone(), kind: kind.clone(), height, at });
            }
        }
        Ok(found)
    }
}

/// The meaning of the columns.
#[derive(Clone, Copy)]
struct Columns {
    east: usize,
    north: usize,
    name: Option<usize>,
    kind: Option<usize>,
    height: Option<usize>,
}

fn position(place: &Value) -> std::result::Result<[f64; 2], String> {
    match (place[0].as_f64(), place[1].as_f64()) {
        (Some(east), Some(north)) => Ok([east, north]),
        _ => Err("a position is not a list of two or three numbers".into()),
    }
}

fn point(
    record: &[String],
    columns: Columns,
    number: impl Fn(&str) -> Option<f64>,
    line: usize,
) -> std::result::Result<NamedPoint, String> {
    let read = |k: usize| match record.get(k) {
        Some(text) => number(text).ok_or_else(|| format!("line {line}: `{}` is not a coordinate", text.escape_debug())),
        None => Err(format!("line {line} has fewer columns than the first")),
    };
    let text = |column: Option<usize>| {
        column.and_then(|at| record.get(at)).map(|text| text.trim()).filter(|text| !text.is_empty()).map(str::to_owned)
    };
    Ok(NamedPoint {
        name: text(columns.name),
        kind: text(columns.kind),
        height: text(columns.height).and_then(|text| number(&text)),
        at: [read(columns.east)?, read(columns.north)?],
    })
}

fn text_of(value: &Value) -> Option<String> {
    match value {
        Value::String(text) => Some(text.trim().to_owned()).filter(|text| !text.is_empty()),
        Value::Number(number) => Some(number.to_string()),
        _ => None,
    }
}

/// The non-empty records of a text, each with its line number.
fn records(text: &str, separator: char) -> std::result::Result<Vec<(usize, Vec<String>)>, String> {
    let mut records = Vec::new();
    let (mut record, mut value) = (Vec::new(), String::new());
    let (mut quoted, mut line, mut first) = (false, 1, 1);
    let mut chars = text.chars().peekable();
    while let Some(char) = chars.next() {
        match char {
            '"' if quoted && chars.next_if_eq(&'"').is_some() => value.push('"'),
            '"' if quoted || value.trim().is_empty() => {
                if !quoted {
                    value.clear();
                }
                quoted = !quoted;
            }
            _ if char == separator && !quoted => record.push(std::mem::take(&mut value)),
            '\n' if !quoted => {
                record.push(std::mem::take(&mut value));
                records.push((first, std::mem::take(&mut record)));
                first = line + 1;
            }
            _ => value.push(char),
        }
        line += usize::from(char == '\n');
    }
    if quoted {
        return Err(format!("line {first}: a quotation mark is not closed"));
    }
    record.push(value);
    records.push((first, record));
    records.retain(|(_, record)| record.iter().any(|value| !value.trim().is_empty()));
    Ok(records)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_folder::TestFolder;

    fn csv(text: &str) -> Vec<(Option<String>, [f64; 2])> {
        NamedPoints::from_csv(text).unwrap().points.into_iter().map(|point| (point.name, point.at)).collect()
    }

    fn some(name: &str, at: [f64; 2]) -> (Option<String>, [f64; 2]) {
        (Some(name.into()), at)
    }

    #[test]
    fn columns_by_their_names_or_in_order() {
        let expect = vec![some("Upper, \"old\"", [1.5, -2.0]), (None, [3.0, 4.0])];
        for text in [
            "name,Easting,NORTHING\r\n\"Upper, \"\"old\"\"\",1.5,-2\r\n\r\n,3,4\r\n",
            "1.5,-2,\"Upper, \"\"old\"\"\"\n3,4",
            "lat;height;lon;station\n-2,0;7;1,5;\"Upper, \"\"old\"\"\"\n4;7;3;\n",
            "y\tx\tid\n-2\t1.5\t Upper, \"old\" \n4\t3\t\n",
        ] {
            assert_eq!(csv(text), expect, "{text}");
        }
        assert_eq!(csv("x,y\n1,2\n"), [(None, [1.0, 2.0])]);
        for (text, expect) in [
            ("place,height\n1,2\n", "line 1 must name the columns"),
            ("x,y\n1,2\n\n\"a\nb\",2\n", "line 4: `a\\nb` is not a coordinate"),
            ("x,y\n1\n", "line 2 has fewer columns"),
            ("x,y\n1,nan\n", "line 2: `nan` is not a coordinate"),
            ("x,y\n1,\"2\n", "line 2: a quotation mark is not closed"),
        ] {
            let why = NamedPoints::from_csv(text).unwrap_err();
            assert!(why.contains(expect), "{why}");
        }
    }

    #[test]
    fn points_of_geojson_with_their_properties() {
        let text = r#"{"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32611"}},"features":[
            {"type":"Feature","properties":{"id":7,"Name":"Gauge"},"geometry":{"type":"Point","coordinates":[1,2,3]}},
            {"type":"Feature","properties":{"id":8},"geometry":{"type":"MultiPoint","coordinates":[[3,4],[5,6]]}},
            {"type":"Feature","properties":null,"geometry":{"type":"LineString","coordinates":[[3,4],[5,6]]}},
            {"type":"Feature","properties":null,"geometry":null}]}"#;
        let found = NamedPoints::from_geojson(text).unwrap();
        assert_eq!(found.epsg, Some(32611));
        let points: Vec<_> = found.points.into_iter().map(|point| (point.name, point.at)).collect();
        assert_eq!(points, [some("Gauge", [1.0, 2.0]), some("8", [3.0, 4.0]), some("8", [5.0, 6.0])]);
        assert_eq!(found.lines, [NamedLine { name: None, kind: None, points: vec![[3.0, 4.0], [5.0, 6.0]] }]);
        let alone = NamedPoints::from_geojson(r#"{"type":"Point","coordinates":[1,2]}"#).unwrap();
        assert_eq!((alone.points[0].at, alone.epsg), ([1.0, 2.0], None));
        for (text, expect) in [
            ("{}", "`type` is missing"),
            ("{", "not valid GeoJSON"),
            (r#"{"type":"Point","coordinates":[1]}"#, "a position is not a list"),
        ] {
            assert!(NamedPoints::from_geojson(text).unwrap_err().contains(expect), "{text}");
        }
    }

    #[test]
    fn kinds_and_heights() {
        let found = NamedPoints::from_csv("name;kind;x;y;ele\nHorn;Summit;1;2;2345,5\nFord;;3;4;\n").unwrap().points;
        assert_eq!((found[0].kind.as_deref(), found[0].height), (Some("Summit"), Some(2345.5)));
        assert_eq!((found[1].kind.as_deref(), found[1].height), (None, None));
        let text = r#"{"type":"FeatureCollection","features":[
            {"type":"Feature","properties":{"name":"Horn","natural":"peak","ele":"2345"},"geometry":{"type":"Point","coordinates":[1,2]}},
            {"type":"Feature","properties":{"name":"Aa","kind":"river"},"geometry":{"type":"MultiLineString","coordinates":[[[3,4],[5,6]],[[7,8]]]}}]}"#;
        let found = NamedPoints::from_geojson(text).unwrap();
        assert_eq!((found.points[0].kind.as_deref(), found.points[0].height), (Some("peak"), Some(2345.0)));
        assert_eq!((found.lines.len(), found.lines[0].kind.as_deref()), (2, Some("river")));
    }

    #[test]
    fn files_by_their_extension() {
        let folder = TestFolder::new("points").unwrap();
        let write = |name: &str, text: &str| {
            let path = folder.join(name);
            std::fs::write(&path, text).unwrap();
            path
        };
        assert_eq!(NamedPoints::read(&write("a.csv", "\u{feff}x,y\n1,2\n"), 1).unwrap().points.len(), 1);
        for (name, text, expect) in [
            ("a.csv", "x,y\n", "it has no points"),
            ("b.csv", "1,2\n3,4\n", "it has 2 points, and at most 1 are read"),
            ("a.gpkg", "", "points are read from .csv and .geojson"),
            ("a.geojson", "[]", "`type` is missing"),
        ] {
            let error = NamedPoints::read(&write(name, text), 1).unwrap_err().to_string();
            assert!(error.contains(expect) && error.contains(name), "{error}");
        }
    }
}
