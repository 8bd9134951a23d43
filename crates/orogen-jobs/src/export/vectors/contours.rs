//! Contours.

use crate::export::contour_options;
use crate::export::contours::{self, Contours};
use crate::export::features::layer::{Maker, Style, VectorLayer};
use crate::export::features::options::FeatureOptions;
use crate::export::features::source::FeatureSource;
use orogen_grid::contour::levels::is_index;
use orogen_grid::error::Result;
use orogen_grid::progress::Progress;
use orogen_io::format::features::{Feature, FeatureLayer, Field, FieldType, Geometry, GeometryType, Value};

/// The layer.
pub static LAYER: VectorLayer = VectorLayer {
    name: "contours",
    about: "contour lines of the heights, higher ground to their left",
    options: &[contour_options::INTERVAL.name, contour_options::LEVELS.name, contour_options::SMOOTH.name],
    style: Style { stroke: "#8a5a2b", width: 0.4, by: None, fill: "none" },
    make: Maker::Ground(make),
};

const FIELDS: &[Field] = &[
    Field { name: "elevation", kind: FieldType::Real, about: "height, m" },
    Field { name: "index", kind: FieldType::Boolean, about: "whether it is an index contour (every fifth contour)" },
];

fn make(ground: &FeatureSource, options: &FeatureOptions, _: &Progress) -> Result<FeatureLayer> {
    let found = match ground.heights() {
        Some(heights) => contours::on(&heights, options.given)?,
        None => Contours { lines: Vec::new(), interval: None },
    };
    Ok(features(&found))
}

/// Contours as features.
pub fn features(found: &Contours) -> FeatureLayer {
    let features = (found.lines.iter())
        .map(|line| Feature {
            geometry: Geometry::Line(line.path().map(|[x, y]| [x, y, 0.0]).collect()),
            values: vec![
                Value::Real(line.elevation),
                Value::Boolean(found.interval.is_some_and(|interval| is_index(line.elevation, interval))),
            ],
        })
        .collect();
    FeatureLayer { name: LAYER.name, about: LAYER.about, geometry: GeometryType::Line, fields: FIELDS, features }
}
