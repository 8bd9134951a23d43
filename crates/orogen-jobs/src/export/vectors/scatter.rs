//! Scattered objects.

use crate::export::features::layer::{Maker, Style, VectorLayer};
use orogen_engine::world::World;
use orogen_grid::error::Result;
use orogen_grid::grid::Window;
use orogen_grid::progress::Progress;
use orogen_io::format::features::{Feature, FeatureLayer, Field, FieldType, Geometry, GeometryType, Value};

/// The layer.
pub static LAYER: VectorLayer = VectorLayer {
    name: "scatter",
    about: "objects of the recipe's scatter, such as trees, with kind, size, turn and height",
    options: &[],
    style: Style { stroke: "none", width: 0.0, by: None, fill: "#2f5d34" },
    make: Maker::World(make),
};

const FIELDS: &[Field] = &[
    Field { name: "kind", kind: FieldType::Text, about: "name of the kind" },
    Field { name: "size", kind: FieldType::Real, about: "scale factor" },
    Field { name: "turn", kind: FieldType::Real, about: "turn in degrees, clockwise seen from above" },
    Field { name: "height", kind: FieldType::Real, about: "height of the ground, m" },
];

/// Memory of a feature in bytes.
const FEATURE_MEMORY: u64 = 320;

fn make(world: &World, window: &Window, progress: &Progress) -> Result<FeatureLayer> {
    let objects = world.objects(window, progress)?;
    world.budget().afford(objects.len() as u64 * FEATURE_MEMORY)?;
    let kinds = world.recipe().scatter();
    let features = objects.iter().map(|object| {
        let [east, south] = object.position;
        let kind = kinds.get(object.entry).map(|scatter| scatter.name.clone()).unwrap_or_default();
        let turn = rounded(object.turn, 1e2) % 360.0;
        let values = vec![
            Value::Text(kind.into()),
            Value::Real(rounded(object.size, 1e4)),
            Value::Real(turn),
            Value::Real(rounded(object.height, 1e3)),
        ];
        Feature { geometry: Geometry::Point([east, south, object.height]), values }
    });
    let features = features.collect();
    Ok(FeatureLayer { name: LAYER.name, about: LAYER.about, geometry: GeometryType::Point, fields: FIELDS, features })
}

/// A number in steps of 1 / `parts`.
fn rounded(value: f64, parts: f64) -> f64 {
    (value * parts).round() / parts
}
