//! Vector features as GIS formats store them: points, lines and polygons with attributes.

use std::borrow::Cow;

use super::coordinates::{self, join};

/// The type of a layer's geometries.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GeometryType {
    /// Points with heights.
    Point,
    /// Lines with a height at each vertex.
    LineZ,
    /// Lines in the plane.
    Line,
    /// Polygons of one or several parts, each with holes.
    MultiPolygon,
}

/// The geometry of one feature.
#[derive(Debug, Clone, PartialEq)]
pub enum Geometry {
    /// A point.
    Point([f64; 3]),
    /// A line; in a layer of 2D lines the heights are 0.
    Line(Vec<[f64; 3]>),
    /// A list of parts, each an outer ring and its holes. The last point of a ring repeats the first. With north up,
    /// outer rings are counter-clockwise and holes clockwise.
    MultiPolygon(Vec<Vec<Ring>>),
}

/// A closed ring.
pub type Ring = Vec<[f64; 2]>;

/// The type of an attribute.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FieldType {
    /// A 64-bit integer.
    Integer,
    /// A 64-bit floating-point number.
    Real,
    /// A boolean.
    Boolean,
    /// A text.
    Text,
}

/// An attribute of the features of a layer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Field {
    /// The name, in lower case with underscores.
    pub name: &'static str,
    /// The type.
    pub kind: FieldType,
    /// Description, with the unit.
    pub about: &'static str,
}

/// The value of an attribute.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// No value.
    Null,
    /// An integer.
    Integer(i64),
    /// A number. If it is not finite, it is written like [`Value::Null`].
    Real(f64),
    /// A boolean.
    Boolean(bool),
    /// A text.
    Text(Cow<'static, str>),
}

/// A feature: a geometry, and one value per field. Features are numbered from 1 in the order of their layer.
#[derive(Debug, Clone, PartialEq)]
pub struct Feature {
    /// The geometry.
    pub geometry: Geometry,
    /// One value for each of the layer's fields.
    pub values: Vec<Value>,
}

impl Value {
    /// A static text.
    #[must_use]
    pub fn text(text: &'static str) -> Value {
        Value::Text(Cow::Borrowed(text))
    }

    /// An optional integer; [`Value::Null`] without a number.
    #[must_use]
    pub fn id(number: Option<u32>) -> Value {
        number.map_or(Value::Null, |number| Value::Integer(i64::from(number)))
    }
}

impl GeometryType {
    /// Whether each vertex has a height.
    #[must_use]
    pub fn has_z(self) -> bool {
        matches!(self, GeometryType::Point | GeometryType::LineZ)
    }
}

impl Geometry {
    fn place(&mut self, map: Option<([f64; 2], [f64; 2])>) {
        match self {
            Geometry::Point(at) => coordinates::place(at, 3, map),
            Geometry::Line(points) => coordinates::place(points.as_flattened_mut(), 3, map),
            Geometry::MultiPolygon(parts) => {
                parts.iter_mut().flatten().for_each(|ring| coordinates::place(ring.as_flattened_mut(), 2, map));
            }
        }
    }

    /// The bounds: west, south, east, north. `None` for empty geometries.
    #[must_use]
    pub fn bounds(&self) -> Option<[f64; 4]> {
        match self {
            Geometry::Point(at) => coordinates::bounds(at, 3, None),
            Geometry::Line(points) => coordinates::bounds(points.as_flattened(), 3, None),
            // Holes are inside the outer ring.
            Geometry::MultiPolygon(parts) => (parts.iter().filter_map(|part| part.first()))
                .fold(None, |others, ring| coordinates::bounds(ring.as_flattened(), 2, others)),
        }
    }

    /// Number of vertices.
    pub fn vertices(&self) -> usize {
        match self {
            Geometry::Point(_) => 1,
            Geometry::Line(points) => points.len(),
            Geometry::MultiPolygon(parts) => parts.iter().flatten().map(Vec::len).sum(),
        }
    }
}

/// The length of a line in the plane; heights are ignored.
#[must_use]
pub fn length(points: &[[f64; 3]]) -> f64 {
    points.windows(2).map(|pair| libm::hypot(pair[1][0] - pair[0][0], pair[1][1] - pair[0][1])).sum()
}

/// Converts features to the coordinates of a map, in which the world's origin is at `origin` and `per_metre` is the
/// number of units per metre. Without a map, y is only negated, so that it points north.
pub fn place(features: &mut [Feature], map: Option<([f64; 2], [f64; 2])>) {
    features.iter_mut().for_each(|feature| feature.geometry.place(map));
}

/// The bounds of all features: west, south, east, north. `None` if there are no vertices.
#[must_use]
pub fn bounds(features: &[Feature]) -> Option<[f64; 4]> {
    features.iter().filter_map(|feature| feature.geometry.bounds()).reduce(join)
}
