//! Points as comma-separated values (RFC 4180), with a header line.

use std::io::{self, Write};

use super::feature_text;
use super::features::FeatureLayer;
use super::number::number;
use super::points::NamedPoint;
use orogen_grid::error::{Error, ErrorKind};

pub use super::number::append_samples;

/// Writes the points of a layer: the columns `x` (east), `y` (north) and `z`, then the attributes; lines end with a
/// line feed. Coordinates are rounded to `decimals` decimals, heights to millimetres. A missing value is empty.
///
/// Fails if `out` fails, or if a feature is not a point.
pub fn write(out: &mut dyn Write, layer: &FeatureLayer, decimals: usize) -> io::Result<()> {
    let names: String = layer.fields.iter().map(|field| format!(",{}", field.name)).collect();
    writeln!(out, "x,y,z{names}")?;
    match feature_text::write_lines(out, &layer.features, decimals)? {
        true => Ok(()),
        false => {
            let message = format!("a .csv file holds points, and the features of `{}` are not", layer.name);
            Err(Error::new(ErrorKind::Request, message).into())
        }
    }
}

/// Writes points with names as [`NamedPoints`](super::points::NamedPoints) reads them: the columns `name`, `kind`, `x`
/// (east), `y` (north) and `height`. Coordinates and heights are rounded to `decimals` decimals.
///
/// Fails if `out` fails.
#[doc(hidden)]
pub fn write_names(out: &mut dyn Write, points: &[NamedPoint], decimals: usize) -> io::Result<()> {
    let mut text = String::from("name,kind,x,y,height\n");
    for NamedPoint { name, kind, height, at } in points {
        for word in [name, kind] {
            text.push_str(&feature_text::quoted(word.as_deref().unwrap_or_default()));
            text.push(',');
        }
        number(&mut text, at[0], decimals);
        text.push(',');
        number(&mut text, at[1], decimals);
        text.push(',');
        height.iter().for_each(|height| number(&mut text, *height, decimals));
        text.push('\n');
    }
    out.write_all(text.as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::features::{GeometryType, Value, samples};
    use crate::format::points::NamedPoints;

    #[test]
    fn a_line_for_each_point() {
        let mut layer = samples::layer("a", GeometryType::Point, 3);
        layer.place(None);
        layer.features[1].values[3] = Value::Text("a, \"b\"".into());
        let mut bytes = Vec::new();
        write(&mut bytes, &layer, 2).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], "x,y,z,id,area,closed,ends_in");
        assert_eq!(lines[1], "0,0,0,1,,true,");
        assert_eq!(lines[2], "370,-530,1,2,1.5,false,\"a, \"\"b\"\"\"");
        assert_eq!(lines.len(), 4);
        let lines = samples::layer("a", GeometryType::Line, 1);
        assert!(write(&mut Vec::new(), &lines, 2).unwrap_err().to_string().contains("holds points"));
    }

    #[test]
    fn names_are_read_again() {
        let point = |name: Option<&str>, height| NamedPoint {
            name: name.map(str::to_owned),
            kind: Some("town".into()),
            height,
            at: [1.5, -20.0],
        };
        let points = [point(Some("Upper, \"old\""), None), point(None, Some(12.5))];
        let mut bytes = Vec::new();
        write_names(&mut bytes, &points, 1).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        assert_eq!(text.lines().nth(1), Some("\"Upper, \"\"old\"\"\",town,1.5,-20,"));
        assert_eq!(NamedPoints::from_csv(&text).unwrap().points, points);
    }
}
