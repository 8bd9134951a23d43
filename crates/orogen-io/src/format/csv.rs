//! Points as comma-separated values (RFC 4180), with a header line.

use std::io::{self, Write};

use super::feature_text;
use super::features::FeatureLayer;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::features::{GeometryType, Value, samples};

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
}
