//! Watersheds.

use crate::export::features::ground::{HIGHEST, LOWEST, MEAN, area, heights};
use crate::export::features::layer::{Maker, Style, VectorLayer};
use crate::export::features::options::{FeatureOptions, WATER};
use crate::export::features::source::FeatureSource;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::hydrography::outlines::outlines;
use orogen_grid::hydrography::rivers::Mouth;
use orogen_grid::hydrography::watersheds::watersheds;
use orogen_grid::progress::Progress;
use orogen_io::format::features::{Feature, FeatureLayer, Field, FieldType, Geometry, GeometryType, Value};

/// The layer.
pub static LAYER: VectorLayer = VectorLayer {
    name: "watersheds",
    about: "watersheds: the land that drains to each river mouth, and the land between them; they cover all land without overlaps",
    options: WATER,
    style: Style { stroke: "#b0413e", width: 0.8, by: None, fill: "none" },
    make: Maker::Ground(make),
};

const FIELDS: &[Field] = &[
    Field { name: "id", kind: FieldType::Integer, about: "number of the watershed, from 1" },
    Field {
        name: "river",
        kind: FieldType::Integer,
        about: "id of the last reach of its river; none if no river drains it",
    },
    Field { name: "area", kind: FieldType::Real, about: "area of its samples, m^2" },
    Field { name: "mouth", kind: FieldType::Text, about: "end of its river: sea, border, or a lake without an outlet" },
    LOWEST,
    HIGHEST,
    MEAN,
];

fn make(ground: &FeatureSource, options: &FeatureOptions, _: &Progress) -> Result<FeatureLayer> {
    let found = watersheds(&ground.water, &ground.frame, &ground.rivers);
    // Labels of the requested samples, which may be finer or coarser than the water's grid.
    let window = ground.requested;
    let [columns, rows] = ground.nearest_lines();
    let (labels, grounds) = found.sampled(&ground.water, &ground.frame, &columns, &rows);
    let labels = Grid::from_data(Window { cell: 1.0, ..window }, labels)
        .ok_or_else(|| Error::new(ErrorKind::Internal, "a sample has no label"))?;
    let [_, cut] = options.rounds();
    let areas = outlines(&labels, found.rivers.len(), cut);
    let mut features = Vec::with_capacity(areas.len());
    let metres = |parts: &[Vec<Vec<[f64; 2]>>]| -> Vec<Vec<Vec<[f64; 2]>>> {
        let ring = |ring: &Vec<[f64; 2]>| ring.iter().map(|at| at.map(|at| at * window.cell)).collect();
        parts.iter().map(|part| part.iter().map(ring).collect()).collect()
    };
    for (k, parts) in areas.iter().enumerate() {
        let (river, known) = (found.rivers[k], grounds[k + 1]);
        if known.count == 0 {
            // The river's last sample is outside the window.
            continue;
        }
        let mouth =
            river.and_then(|river| ground.rivers.get(river as usize)).map_or(Value::Null, |river| match river.mouth {
                Mouth::Sea => Value::text("sea"),
                Mouth::Lake(_) => Value::text("lake"),
                _ => Value::text("border"),
            });
        let mut values = vec![
            Value::Integer(features.len() as i64 + 1),
            Value::id(river.map(|river| river + 1)),
            area(&known, window.cell),
            mouth,
        ];
        values.extend(heights(&known));
        features.push(Feature { geometry: Geometry::MultiPolygon(metres(parts)), values });
    }
    Ok(FeatureLayer {
        name: LAYER.name,
        about: LAYER.about,
        geometry: GeometryType::MultiPolygon,
        fields: FIELDS,
        features,
    })
}
