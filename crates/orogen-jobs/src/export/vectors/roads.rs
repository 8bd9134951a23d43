//! Roads, bridges and tunnels.

use crate::export::features::layer::{Maker, Style, VectorLayer};
use orogen_engine::world::World;
use orogen_grid::error::Result;
use orogen_grid::grid::Window;
use orogen_grid::hydrography::clip::Rectangle;
use orogen_grid::progress::Progress;
use orogen_io::format::features::{Feature, FeatureLayer, Field, FieldType, Geometry, GeometryType, Value, length};

/// The layer.
pub static LAYER: VectorLayer = VectorLayer {
    name: "roads",
    about: "roads, bridges and tunnels of the recipe's nodes `roads`, with kind, length and grade",
    options: &[],
    style: Style { stroke: "#b3352a", width: 1.6, by: None, fill: "none" },
    make: Maker::World(make),
};

const FIELDS: &[Field] = &[
    Field { name: "kind", kind: FieldType::Text, about: "road, bridge or tunnel" },
    Field { name: "road", kind: FieldType::Integer, about: "number of the list of places that it was built for" },
    Field { name: "node", kind: FieldType::Text, about: "name of the node" },
    Field { name: "length", kind: FieldType::Real, about: "horizontal length, m" },
    Field { name: "grade", kind: FieldType::Real, about: "largest grade, rise over run" },
    Field { name: "steep", kind: FieldType::Real, about: "length that is steeper than the node's `grade`, m" },
];

/// Memory of a feature without its points, and of a point, in bytes.
const FEATURE_MEMORY: u64 = 400;
const POINT_MEMORY: u64 = 48;

/// A share of the maximum grade that is rounding.
const ROUNDING: f64 = 1e-6;

fn make(world: &World, window: &Window, progress: &Progress) -> Result<FeatureLayer> {
    let roads = world.roads(progress)?;
    let points: usize = roads.iter().map(|road| road.line.points.len()).sum();
    world.budget().afford((points as u64 * POINT_MEMORY).saturating_add(roads.len() as u64 * FEATURE_MEMORY))?;
    let side = |first: i64, count: usize| [first as f64 - 0.5, (first + count as i64) as f64 - 0.5];
    let ([west, east], [north, south]) = (side(window.x, window.width), side(window.y, window.height));
    let rectangle = Rectangle { sides: [west, north, east, south].map(|side| side * window.cell) };
    let mut features = Vec::new();
    for road in &roads {
        for (kind, range) in road.line.stretches() {
            for piece in rectangle.pieces(&road.line.points[range]) {
                if piece.points.len() < 2 {
                    continue;
                }
                let [grade, steep] = grades(&piece.points, road.grade);
                let values = vec![
                    Value::text(kind.name()),
                    Value::Integer(road.line.road as i64 + 1),
                    Value::Text(road.node.clone().into()),
                    Value::Real(length(&piece.points)),
                    Value::Real(grade),
                    Value::Real(steep),
                ];
                features.push(Feature { geometry: Geometry::Line(piece.points), values });
            }
        }
    }
    Ok(FeatureLayer { name: LAYER.name, about: LAYER.about, geometry: GeometryType::LineZ, fields: FIELDS, features })
}

/// The largest grade of a line, and the length that is steeper than a limit.
fn grades(points: &[[f64; 3]], limit: f64) -> [f64; 2] {
    let (mut largest, mut steep) = (0.0f64, 0.0);
    for pair in points.windows(2) {
        let run = length(pair);
        let grade = if run > 0.0 { (pair[1][2] - pair[0][2]).abs() / run } else { 0.0 };
        largest = largest.max(grade);
        steep += if grade > limit * (1.0 + ROUNDING) { run } else { 0.0 };
    }
    // In steps of 1 / 10 000, so that rounding does not show.
    [(largest * 1e4).round() / 1e4, steep]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steep_parts_are_counted() {
        let points = [[0.0, 0.0, 10.0], [100.0, 0.0, 18.0], [100.0, 50.0, 24.0], [100.0, 50.0, 24.0]];
        assert_eq!(grades(&points, 0.08), [0.12, 50.0]);
        assert_eq!(grades(&points, 0.12), [0.12, 0.0]);
    }
}
