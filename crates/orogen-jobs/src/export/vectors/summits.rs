//! Summits.

use crate::export::features::layer::{Maker, Style, VectorLayer};
use crate::export::features::options::{FeatureOptions, PROMINENCE};
use crate::export::features::source::FeatureSource;
use orogen_grid::error::Result;
use orogen_grid::hydrography::summits::summits;
use orogen_grid::progress::Progress;
use orogen_io::format::features::{Feature, FeatureLayer, Field, FieldType, Geometry, GeometryType, Value};
use orogen_io::format::levels::{NO_SAMPLES, extremes};

/// The layer.
pub static LAYER: VectorLayer = VectorLayer {
    name: "summits",
    about: "summits with height and prominence, the most prominent first",
    options: &[PROMINENCE.name],
    style: Style { stroke: "#222222", width: 0.5, by: None, fill: "#222222" },
    make: Maker::Ground(make),
};

const FIELDS: &[Field] = &[
    Field { name: "id", kind: FieldType::Integer, about: "number of the summit, from 1" },
    Field { name: "height", kind: FieldType::Real, about: "height, m" },
    Field {
        name: "prominence",
        kind: FieldType::Real,
        about: "prominence, m: height above the key col; for the highest summit, above the sea or the lowest ground",
    },
    Field {
        name: "key_col",
        kind: FieldType::Real,
        about: "height of the key col, the highest pass to higher ground, m",
    },
];

/// Minimum prominence of a summit, as a share of the relief.
const SHARE: f64 = 1.0 / 25.0;

fn make(ground: &FeatureSource, options: &FeatureOptions, _: &Progress) -> Result<FeatureLayer> {
    let water = &ground.water;
    let in_frame = |row: usize| &water.heights.row(row)[ground.frame.columns.clone()];
    let range = ground.frame.rows.clone().map(in_frame).fold(NO_SAMPLES, extremes);
    let relief = range[1] - range[0];
    let least = options.given.number(PROMINENCE.name).unwrap_or(f64::from(relief) * SHARE);
    let found = summits(&water.heights, &ground.frame, water.sea_level, least as f32);
    let features = (1..).zip(found).map(|(id, summit)| {
        let [east, south] = ground.place(summit.place.map(|c| c as f64));
        let col = summit.col.map_or(Value::Null, |[i, j]| Value::Real(f64::from(water.heights[(i, j)])));
        let values = vec![
            Value::Integer(id),
            Value::Real(f64::from(summit.height)),
            Value::Real(f64::from(summit.prominence)),
            col,
        ];
        Feature { geometry: Geometry::Point([east, south, f64::from(summit.height)]), values }
    });
    let features = features.collect();
    Ok(FeatureLayer { name: LAYER.name, about: LAYER.about, geometry: GeometryType::Point, fields: FIELDS, features })
}
