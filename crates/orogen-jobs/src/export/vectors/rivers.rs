//! Rivers.

use crate::export::features::layer::{Maker, Style, VectorLayer};
use crate::export::features::options::{FeatureOptions, WATER};
use crate::export::features::source::FeatureSource;
use orogen_grid::error::Result;
use orogen_grid::hydrography::rivers::{Mouth, Source};
use orogen_grid::progress::Progress;
use orogen_io::format::features::{Feature, FeatureLayer, Field, FieldType, Geometry, GeometryType, Value, length};

/// The layer.
pub static LAYER: VectorLayer = VectorLayer {
    name: "rivers",
    about: "river reaches, from spring, confluence or lake to confluence, lake, sea or border",
    options: WATER,
    style: Style { stroke: "#3f7fb5", width: 1.0, by: Some("discharge"), fill: "none" },
    make: Maker::Ground(make),
};

const FIELDS: &[Field] = &[
    Field { name: "id", kind: FieldType::Integer, about: "number of the reach, from 1" },
    Field {
        name: "downstream",
        kind: FieldType::Integer,
        about: "id of the next reach downstream; if the reach ends in a lake, the reach that leaves the lake",
    },
    Field {
        name: "strahler",
        kind: FieldType::Integer,
        about: "Strahler order; none if a part of the catchment lies beyond the window and was not computed",
    },
    Field { name: "drainage_area", kind: FieldType::Real, about: "drainage area at the end of the reach, m^2" },
    Field { name: "discharge", kind: FieldType::Real, about: "mean discharge at the end of the reach, m^3/s" },
    Field { name: "width", kind: FieldType::Real, about: "width at the end of the reach, m" },
    Field { name: "length", kind: FieldType::Real, about: "horizontal length, m" },
    Field { name: "bed_start", kind: FieldType::Real, about: "height of the first point, m" },
    Field { name: "bed_end", kind: FieldType::Real, about: "height of the last point, m" },
    Field { name: "source", kind: FieldType::Text, about: "start of the reach: land, lake or border" },
    Field { name: "source_lake", kind: FieldType::Integer, about: "id of the lake that it starts from" },
    Field { name: "mouth", kind: FieldType::Text, about: "end of the reach: reach, lake, sea or border" },
    Field { name: "mouth_lake", kind: FieldType::Integer, about: "id of the lake that it ends in" },
];

fn make(ground: &FeatureSource, options: &FeatureOptions, _: &Progress) -> Result<FeatureLayer> {
    let cell_area = ground.cell() * ground.cell();
    let mut features = Vec::with_capacity(ground.rivers.len());
    for (id, river) in (1..).zip(&ground.rivers) {
        let points: Vec<[f64; 3]> = (river.points.iter())
            .map(|[x, y, z]| {
                let [east, south] = ground.place([*x, *y]);
                [east, south, *z]
            })
            .collect();
        let area = river.drained * cell_area;
        let discharge = options.channel.discharge(area);
        let (source, source_lake) = match river.source {
            Source::Land => ("land", None),
            Source::Lake(lake) => ("lake", ground.lake_id(lake)),
            Source::Border => ("border", None),
        };
        let (mouth, mouth_lake) = match river.mouth {
            Mouth::Reach(_) => ("reach", None),
            Mouth::Lake(lake) => ("lake", ground.lake_id(lake)),
            Mouth::Sea => ("sea", None),
            Mouth::Border => ("border", None),
        };
        let end = |point: Option<&[f64; 3]>| point.map_or(Value::Null, |point| Value::Real(point[2]));
        let values = vec![
            Value::Integer(id),
            Value::id(river.downstream.map(|next| next + 1)),
            Value::id((river.order > 0).then_some(u32::from(river.order))),
            Value::Real(area),
            Value::Real(discharge),
            Value::Real(options.channel.width_of(discharge)),
            Value::Real(length(&points)),
            end(points.first()),
            end(points.last()),
            Value::text(source),
            Value::id(source_lake),
            Value::text(mouth),
            Value::id(mouth_lake),
        ];
        features.push(Feature { geometry: Geometry::Line(points), values });
    }
    Ok(FeatureLayer { name: LAYER.name, about: LAYER.about, geometry: GeometryType::LineZ, fields: FIELDS, features })
}
