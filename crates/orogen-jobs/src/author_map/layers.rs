//! The parts of a map as vector features.

use std::borrow::Cow;

use orogen_grid::grid::Grid;
use orogen_io::format::features::{Feature, FeatureLayer, Field, FieldType, Geometry, GeometryType, Ring, Value};
use orogen_io::format::fmg::{FmgMap, Lake, River};
use orogen_io::format::points::NamedPoint;

use super::courses::courses;

const NAME: Field = Field { name: "name", kind: FieldType::Text, about: "name" };

const COAST: &[Field] = &[];
const LAKES: &[Field] =
    &[NAME, Field { name: "height", kind: FieldType::Real, about: "height of the surface on the map, m" }];
const RIVERS: &[Field] = &[
    NAME,
    Field { name: "width", kind: FieldType::Real, about: "width at the mouth, m" },
    Field { name: "discharge", kind: FieldType::Real, about: "discharge at the mouth, m^3/s" },
    Field { name: "main", kind: FieldType::Integer, about: "id of the river that it ends in" },
];

/// The polygons of the land, with the lakes.
pub fn coast(map: &FmgMap) -> FeatureLayer {
    let polygon =
        |part: &Vec<Ring>| Feature { geometry: Geometry::MultiPolygon(vec![part.clone()]), values: Vec::new() };
    placed(FeatureLayer {
        name: "coast",
        about: "land, with its lakes",
        geometry: GeometryType::MultiPolygon,
        fields: COAST,
        features: map.coast.iter().map(polygon).collect(),
    })
}

/// The lakes.
pub fn lakes(map: &FmgMap) -> FeatureLayer {
    let lake = |lake: &Lake| Feature {
        geometry: Geometry::MultiPolygon(lake.parts.clone()),
        values: vec![text(&lake.name), lake.height.map_or(Value::Null, rounded)],
    };
    placed(FeatureLayer {
        name: "lakes",
        about: "lakes",
        geometry: GeometryType::MultiPolygon,
        fields: LAKES,
        features: map.lakes.iter().map(lake).collect(),
    })
}

/// The rivers along their courses from source to mouth, main rivers before their tributaries.
pub fn rivers(map: &FmgMap, heights: &Grid) -> FeatureLayer {
    let river = |(river, points): (&River, Vec<[f64; 3]>)| Feature {
        geometry: Geometry::Line(points),
        values: vec![
            text(&river.name),
            river.width.map_or(Value::Null, rounded),
            river.discharge.map_or(Value::Null, rounded),
            river.parent.map_or(Value::Null, |parent| Value::Integer(parent as i64 + 1)),
        ],
    };
    placed(FeatureLayer {
        name: "rivers",
        about: "rivers from source to mouth, with the height of the bed",
        geometry: GeometryType::LineZ,
        fields: RIVERS,
        features: map.rivers.iter().zip(courses(map, heights)).map(river).collect(),
    })
}

/// The names of a map: settlements, lakes and rivers, as metres east and north.
pub fn names(map: &FmgMap) -> Vec<NamedPoint> {
    let point = |name: &str, kind: &str, [x, y]: [f64; 2]| NamedPoint {
        name: Some(name.to_owned()),
        kind: Some(kind.to_owned()),
        height: None,
        at: [x, -y],
    };
    let settlements = map.settlements.iter().map(|settlement| {
        let kind = if settlement.is_capital { "capital" } else { "town" };
        point(&settlement.name, kind, settlement.at)
    });
    let lakes = map.lakes.iter().map(|lake| point(&lake.name, "lake", lake.middle));
    let rivers = map.rivers.iter().filter_map(|river| Some((river, *river.points.get(river.points.len() / 2)?)));
    let rivers = rivers.map(|(river, at)| point(&river.name, "river", at));
    let all = settlements.chain(lakes).chain(rivers);
    all.filter(|point| point.name.as_ref().is_some_and(|name| !name.is_empty())).collect()
}

fn placed(mut layer: FeatureLayer) -> FeatureLayer {
    layer.place(None);
    layer
}

fn text(text: &str) -> Value {
    if text.is_empty() { Value::Null } else { Value::Text(Cow::Owned(text.to_owned())) }
}

fn rounded(number: f64) -> Value {
    Value::Real((number * 100.0).round() / 100.0)
}
