//! Features as text: members of a GeoJSON collection, and lines of a CSV file.

use std::borrow::Cow;
use std::fmt::Write as _;
use std::io::{self, Write};

use super::coordinates::{append_list, append_position};
use super::features::{Feature, Field, Geometry, Value};
use super::number::number;

/// Writes features as members of a GeoJSON list, one per line. Coordinates are rounded to `decimals` decimals, heights
/// to millimetres.
///
/// # Errors
/// If `out` fails.
pub fn write_json(
    out: &mut dyn Write,
    fields: &[Field],
    features: &[Feature],
    has_z: bool,
    decimals: usize,
) -> io::Result<()> {
    let mut text = String::new();
    for (k, feature) in features.iter().enumerate() {
        text.clear();
        if k > 0 {
            text.push_str(",\n");
        }
        let _ = write!(text, "{{\"type\":\"Feature\",\"id\":{},\"properties\":{{", k + 1);
        for (i, (field, value)) in fields.iter().zip(&feature.values).enumerate() {
            let _ = write!(text, "{}\"{}\":", if i > 0 { "," } else { "" }, field.name);
            let _ = match value {
                Value::Integer(number) => write!(text, "{number}"),
                Value::Real(number) if number.is_finite() => write!(text, "{number}"),
                Value::Boolean(is) => write!(text, "{is}"),
                Value::Text(word) => write!(text, "{}", serde_json::Value::from(word.as_ref())),
                Value::Null | Value::Real(_) => write!(text, "null"),
            };
        }
        text.push_str("},\"geometry\":{");
        geometry(&mut text, &feature.geometry, has_z, decimals);
        text.push_str("}}");
        out.write_all(text.as_bytes())?;
    }
    Ok(())
}

fn geometry(text: &mut String, geometry: &Geometry, z: bool, decimals: usize) {
    let numbers = if z { 3 } else { 2 };
    match geometry {
        Geometry::Point(at) => {
            text.push_str("\"type\":\"Point\",\"coordinates\":");
            append_position(text, &at[..numbers], decimals);
        }
        Geometry::Line(points) => {
            text.push_str("\"type\":\"LineString\",\"coordinates\":");
            append_list(text, points.as_flattened(), 3, numbers, decimals);
        }
        Geometry::MultiPolygon(parts) => {
            text.push_str("\"type\":\"MultiPolygon\",\"coordinates\":");
            list(text, parts, |text, part| {
                list(text, part, |text, ring| append_list(text, ring.as_flattened(), 2, 2, decimals));
            });
        }
    }
}

fn list<T>(text: &mut String, items: &[T], mut item: impl FnMut(&mut String, &T)) {
    text.push('[');
    for (k, one) in items.iter().enumerate() {
        if k > 0 {
            text.push(',');
        }
        item(text, one);
    }
    text.push(']');
}

/// Writes points as lines of a CSV file: east, north, height and the attributes. Coordinates are rounded to `decimals`
/// decimals, heights to millimetres. Returns false at the first feature that is not a point; the features before it
/// have then been written.
///
/// # Errors
/// If `out` fails.
pub fn write_lines(out: &mut dyn Write, features: &[Feature], decimals: usize) -> io::Result<bool> {
    let mut text = String::new();
    for feature in features {
        let Geometry::Point([x, y, z]) = feature.geometry else { return Ok(false) };
        text.clear();
        for (k, (value, decimals)) in [(x, decimals), (y, decimals), (z, 3)].into_iter().enumerate() {
            text.push_str(if k > 0 { "," } else { "" });
            number(&mut text, value, decimals);
        }
        for value in &feature.values {
            text.push(',');
            let _ = match value {
                Value::Integer(number) => write!(text, "{number}"),
                Value::Real(number) if number.is_finite() => write!(text, "{number}"),
                Value::Boolean(is) => write!(text, "{is}"),
                Value::Text(word) => write!(text, "{}", quoted(word)),
                Value::Null | Value::Real(_) => Ok(()),
            };
        }
        text.push('\n');
        out.write_all(text.as_bytes())?;
    }
    Ok(true)
}

/// A text as a value of a CSV file (RFC 4180), in quotes if it needs them.
#[must_use]
pub fn quoted(word: &str) -> Cow<'_, str> {
    match word.contains([',', '"', '\n', '\r']) {
        true => Cow::Owned(format!("\"{}\"", word.replace('"', "\"\""))),
        false => Cow::Borrowed(word),
    }
}
