//! Watersheds.

use crate::export::features::layer::{Style, VectorLayer};
use crate::export::features::options::{FeatureOptions, WATER};
use crate::export::features::source::FeatureSource;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::hydrography::outlines::outlines;
use orogen_grid::hydrography::rivers::Mouth;
use orogen_grid::hydrography::watersheds::watersheds;
use orogen_io::format::features::{Feature, FeatureLayer, Field, FieldType, Geometry, GeometryType, Value};

/// The layer.
pub static LAYER: VectorLayer = VectorLayer {
    name: "watersheds",
    about: "watersheds: the land that drains to each river mouth, and the land between them; they cover all land without overlaps",
    options: WATER,
    style: Style { stroke: "#b0413e", width: 0.8, by: None, fill: "none" },
    make,
};

const FIELDS: &[Field] = &[
    Field { name: "id", kind: FieldType::Integer, about: "number of the watershed, from 1" },
    Field {
        name: "river",
        kind: FieldType::Integer,
        about: "id of the last reach of its river; none if no river drains it",
    },
    Field { name: "area", kind: FieldType::Real, about: "area of its samples, m^2" },
    Field { name: "mouth", kind: FieldType::Text, about: "end of its river: sea or border" },
    Field { name: "lowest", kind: FieldType::Real, about: "lowest height, m" },
    Field { name: "highest", kind: FieldType::Real, about: "highest height, m" },
    Field { name: "mean", kind: FieldType::Real, about: "mean height, m" },
];

/// Attributes of a watershed.
#[derive(Clone, Copy)]
struct Measures {
    count: u64,
    low: f32,
    high: f32,
    sum: f64,
}

fn make(ground: &FeatureSource, options: &FeatureOptions) -> Result<FeatureLayer> {
    let found = watersheds(&ground.water, &ground.frame, &ground.rivers);
    let window = Window::new(ground.frame.columns.len(), ground.frame.rows.len(), 1.0)
        .at(ground.frame.columns.start as i64, ground.frame.rows.start as i64);
    let none = Measures { count: 0, low: f32::INFINITY, high: f32::NEG_INFINITY, sum: 0.0 };
    let mut measures = vec![none; found.rivers.len() + 1];
    for (k, label) in found.labels.iter().enumerate().filter(|(_, label)| **label > 0) {
        let (i, j) = (ground.frame.columns.start + k % window.width, ground.frame.rows.start + k / window.width);
        let height = ground.water.heights[(i, j)];
        let known = &mut measures[*label as usize];
        known.count += 1;
        known.sum += f64::from(height);
        (known.low, known.high) = (known.low.min(height), known.high.max(height));
    }
    let [_, cut] = options.rounds();
    let labels = Grid::from_data(window, found.labels).unwrap_or_else(|| Grid::filled(window, 0));
    let areas = outlines(&labels, found.rivers.len(), cut);
    let cell_area = ground.cell() * ground.cell();
    let mut features = Vec::with_capacity(areas.len());
    for (k, parts) in areas.iter().enumerate() {
        let (river, known) = (found.rivers[k], measures[k + 1]);
        let mouth =
            river.and_then(|river| ground.rivers.get(river as usize)).map_or(Value::Null, |river| match river.mouth {
                Mouth::Sea => Value::Text("sea"),
                _ => Value::Text("border"),
            });
        let values = vec![
            Value::Integer(k as i64 + 1),
            Value::id(river.map(|river| river + 1)),
            Value::Real(known.count as f64 * cell_area),
            mouth,
            Value::Real(f64::from(known.low)),
            Value::Real(f64::from(known.high)),
            Value::Real(known.sum / known.count as f64),
        ];
        features.push(Feature { geometry: Geometry::MultiPolygon(ground.parts(parts)), values });
    }
    Ok(FeatureLayer {
        name: LAYER.name,
        about: LAYER.about,
        geometry: GeometryType::MultiPolygon,
        fields: FIELDS,
        features,
    })
}
