//! Lakes.

use crate::export::features::layer::{Maker, Style, VectorLayer};
use crate::export::features::options::{FeatureOptions, WATER};
use crate::export::features::source::FeatureSource;
use orogen_grid::contour::line::twice_area;
use orogen_grid::error::Result;
use orogen_grid::hydrography::rivers::Source;
use orogen_grid::progress::Progress;
use orogen_io::format::features::{Feature, FeatureLayer, Field, FieldType, Geometry, GeometryType, Value};

/// The layer.
pub static LAYER: VectorLayer = VectorLayer {
    name: "lakes",
    about: "lakes, with islands as holes",
    options: WATER,
    style: Style { stroke: "#2f6a9e", width: 0.5, by: None, fill: "#9fc8e4" },
    make: Maker::Ground(make),
};

const FIELDS: &[Field] = &[
    Field { name: "id", kind: FieldType::Integer, about: "number of the lake, from 1" },
    Field { name: "level", kind: FieldType::Real, about: "height of the surface, m" },
    Field { name: "area", kind: FieldType::Real, about: "area of the surface, m^2" },
    Field { name: "depth", kind: FieldType::Real, about: "maximum depth, m" },
    Field { name: "volume", kind: FieldType::Real, about: "volume of the water, m^3" },
    Field {
        name: "outlet",
        kind: FieldType::Integer,
        about: "id of the reach that leaves it; none if the outflow is too small for a river",
    },
];

fn make(ground: &FeatureSource, _: &FeatureOptions, _: &Progress) -> Result<FeatureLayer> {
    let water = &ground.water;
    let cell_area = ground.cell() * ground.cell();
    let volumes = water.lake_volumes(&ground.frame, cell_area);
    let mut outlets = vec![None; water.lakes.len() + 1];
    for (id, river) in (1..).zip(&ground.rivers) {
        // A lake without any sample has no number.
        if let Source::Lake(lake) = river.source
            && let Some(outlet) = outlets.get_mut(lake as usize)
        {
            *outlet = Some(id);
        }
    }
    let mut features = Vec::with_capacity(ground.lakes.len());
    for (id, area) in (1..).zip(&ground.lakes) {
        let Some(lake) = water.lakes.get(area.lake as usize - 1) else { continue };
        let parts = ground.parts(&area.parts);
        let surface: f64 = parts.iter().flatten().map(|ring| twice_area(ring) / 2.0).sum();
        let deepest = water.heights.data()[lake.deepest as usize];
        let values = vec![
            Value::Integer(id),
            Value::Real(f64::from(lake.level)),
            Value::Real(surface),
            Value::Real(f64::from(lake.level) - f64::from(deepest)),
            Value::Real(volumes[area.lake as usize]),
            Value::id(outlets[area.lake as usize]),
        ];
        features.push(Feature { geometry: Geometry::MultiPolygon(parts), values });
    }
    Ok(FeatureLayer {
        name: LAYER.name,
        about: LAYER.about,
        geometry: GeometryType::MultiPolygon,
        fields: FIELDS,
        features,
    })
}
