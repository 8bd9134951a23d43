//! The coast.

use crate::export::contour_options;
use crate::export::features::layer::{Maker, Style, VectorLayer};
use crate::export::features::options::FeatureOptions;
use crate::export::features::source::FeatureSource;
use orogen_grid::error::Result;
use orogen_grid::progress::Progress;
use orogen_io::format::features::{Feature, FeatureLayer, Field, FieldType, Geometry, GeometryType, Value, length};

/// The layer.
pub static LAYER: VectorLayer = VectorLayer {
    name: "coast",
    about: "the coast of the sea, land to its left",
    options: &[contour_options::SMOOTH.name],
    style: Style { stroke: "#1f4e79", width: 1.0, by: None, fill: "none" },
    make: Maker::Ground(make),
};

const FIELDS: &[Field] = &[
    Field { name: "id", kind: FieldType::Integer, about: "number of the line, from 1" },
    Field { name: "elevation", kind: FieldType::Real, about: "sea level, m" },
    Field { name: "length", kind: FieldType::Real, about: "length, m" },
    Field { name: "closed", kind: FieldType::Boolean, about: "whether the line is closed" },
];

fn make(ground: &FeatureSource, _: &FeatureOptions, _: &Progress) -> Result<FeatureLayer> {
    let level = f64::from(ground.water.sea_level.unwrap_or_default());
    let coast = |(id, line): (i64, &Vec<[f64; 2]>)| {
        let points: Vec<[f64; 3]> = (line.iter())
            .map(|at| {
                let [east, south] = ground.place(*at);
                [east, south, 0.0]
            })
            .collect();
        let closed = points.first() == points.last();
        let values = vec![Value::Integer(id), Value::Real(level), Value::Real(length(&points)), Value::Boolean(closed)];
        Feature { geometry: Geometry::Line(points), values }
    };
    let features = (1..).zip(ground.shores.coasts()).map(coast).collect();
    Ok(FeatureLayer { name: LAYER.name, about: LAYER.about, geometry: GeometryType::Line, fields: FIELDS, features })
}
