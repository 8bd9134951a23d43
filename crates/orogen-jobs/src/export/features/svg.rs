//! Layers of features as SVG.

use std::io::{self, Write};

use super::layer::Style;
use orogen_grid::grid::Window;
use orogen_io::format::features::{Feature, FeatureLayer, Geometry, GeometryType, Value};
use orogen_io::format::geojson::{decimals, number};
use orogen_io::format::svg::{MAX_PATH, pad};

/// Longer side in pixels.
const LONGER: f64 = 1000.0;

/// Writes layers, in metres of the world, as an SVG with the extent of the window, north up. Each layer is a group with
/// its name that contains a path per feature. Layers of polygons come first, layers of points last.
///
/// Fails if `out` fails.
pub fn write(out: &mut dyn Write, layers: &[(FeatureLayer, Style)], window: &Window) -> io::Result<()> {
    let size = [window.width, window.height].map(|samples| samples.saturating_sub(1).max(1) as f64 * window.cell);
    let unit = size[0].max(size[1]) / LONGER;
    writeln!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\" viewBox=\"0 0 {} {}\">",
        (size[0] / unit).round().max(1.0),
        (size[1] / unit).round().max(1.0),
        size[0],
        size[1]
    )?;
    let mut sorted: Vec<&(FeatureLayer, Style)> = layers.iter().collect();
    // Filled polygons are below lines, and lines are below points.
    sorted.sort_by_key(|(layer, style)| (layer.geometry == GeometryType::Point, style.fill == "none"));
    let pen = Pen { origin: [window.east(0), window.south(0)], decimals: decimals(window.cell), unit };
    let mut text = String::new();
    for (layer, style) in sorted {
        writeln!(
            out,
            "<g id=\"{}\" fill=\"{}\" fill-rule=\"evenodd\" stroke=\"{}\" stroke-width=\"{:.4}\" stroke-linejoin=\"round\" \
             stroke-linecap=\"round\">",
            layer.name,
            style.fill,
            style.stroke,
            style.width * unit
        )?;
        let by = style.by.and_then(|by| layer.fields.iter().position(|field| field.name == by));
        let value = |feature: &Feature| match by.and_then(|by| feature.values.get(by)) {
            Some(Value::Real(value)) => *value,
            _ => 0.0,
        };
        let most = layer.features.iter().map(value).fold(0.0, f64::max);
        for feature in &layer.features {
            text.clear();
            pen.path(&mut text, &feature.geometry);
            match most > 0.0 {
                true => {
                    let width = style.width * unit * (0.5 + 3.5 * (value(feature) / most).sqrt());
                    writeln!(out, "<path stroke-width=\"{width:.4}\" d=\"{text}\"/>")?;
                }
                false => writeln!(out, "<path d=\"{text}\"/>")?,
            }
            if text.len() > MAX_PATH {
                pad(out)?;
            }
        }
        writeln!(out, "</g>")?;
    }
    writeln!(out, "</svg>")
}

struct Pen {
    origin: [f64; 2],
    decimals: usize,
    unit: f64,
}

impl Pen {
    fn path(&self, text: &mut String, geometry: &Geometry) {
        match geometry {
            Geometry::Point([x, y, _]) => {
                // A triangle around the point.
                let unit = self.unit;
                let corners = [[0.0, -4.0], [3.5, 2.5], [-3.5, 2.5]].map(|[u, v]| [x + u * unit, y + v * unit]);
                self.points(text, corners.into_iter());
                text.push('Z');
            }
            Geometry::Line(points) => self.points(text, points.iter().map(|[x, y, _]| [*x, *y])),
            Geometry::MultiPolygon(parts) => {
                for ring in parts.iter().flatten() {
                    self.points(text, ring.iter().take(ring.len().saturating_sub(1)).copied());
                    text.push('Z');
                }
            }
        }
    }

    fn points(&self, text: &mut String, points: impl Iterator<Item = [f64; 2]>) {
        for (k, [x, y]) in points.enumerate() {
            text.push(if k == 0 { 'M' } else { 'L' });
            number(text, x - self.origin[0], self.decimals);
            text.push(' ');
            number(text, y - self.origin[1], self.decimals);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::vectors;
    use orogen_io::format::features::samples;

    #[test]
    fn a_group_for_each_layer_and_a_path_for_each_feature() {
        let layers = [
            (samples::layer("summits", GeometryType::Point, 2), vectors::summits::LAYER.style),
            (
                samples::layer("rivers", GeometryType::LineZ, 3),
                Style { by: Some("area"), ..vectors::rivers::LAYER.style },
            ),
            (samples::layer("lakes", GeometryType::MultiPolygon, 1), vectors::lakes::LAYER.style),
        ];
        let mut bytes = Vec::new();
        write(&mut bytes, &layers, &Window::new(101, 51, 10.0)).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        assert!(text.contains("width=\"1000\" height=\"500\" viewBox=\"0 0 1000 500\""), "{text}");
        let at = |name: &str| text.find(&format!("<g id=\"{name}\"")).unwrap();
        assert!(at("lakes") < at("rivers") && at("rivers") < at("summits"));
        assert_eq!(text.matches("<path").count(), 6);
        assert!(text.contains("d=\"M0 0L8 0L8 8L0 8Z"), "{text}");
    }
}
