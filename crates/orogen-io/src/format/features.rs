//! Vector features: what GIS formats of points, lines and polygons hold.

use super::dem::Georeference;

/// The type of a layer's geometries.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GeometryType {
    /// Points with heights.
    Point,
    /// Lines with a height at each vertex.
    LineZ,
    /// Lines in the plane.
    Line,
    /// Areas of one or several parts, each with holes.
    MultiPolygon,
}

/// The geometry of one feature.
#[derive(Debug, Clone, PartialEq)]
pub enum Geometry {
    /// A point.
    Point([f64; 3]),
    /// A line; of a layer of plane lines the heights are 0.
    Line(Vec<[f64; 3]>),
    /// Parts, each an outer ring and its holes. The last point of a ring repeats the first. With north up, outer rings are counter-clockwise and
    /// holes clockwise.
    MultiPolygon(Vec<Vec<Ring>>),
}

/// A closed ring.
pub type Ring = Vec<[f64; 2]>;

/// The type of an attribute.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FieldType {
    /// A 64-bit whole number.
    Integer,
    /// A 64-bit floating-point number.
    Real,
    /// A truth value.
    Boolean,
    /// A text.
    Text,
}

/// An attribute that the features of a layer have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Field {
    /// Its name: lower case, with underscores.
    pub name: &'static str,
    /// Its type.
    pub kind: FieldType,
    /// What it is, with its unit.
    pub about: &'static str,
}

/// The value of an attribute.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// None.
    Null,
    /// A whole number.
    Integer(i64),
    /// A number; one that is not finite is written as [`Value::Null`].
    Real(f64),
    /// A truth value.
    Boolean(bool),
    /// A text.
    Text(&'static str),
}

/// A feature: where it is, and one value a field. Features are numbered from 1 in their layer's order.
#[derive(Debug, Clone, PartialEq)]
pub struct Feature {
    /// Where it is.
    pub geometry: Geometry,
    /// One value for each of the layer's fields.
    pub values: Vec<Value>,
}

/// Features of one kind.
#[derive(Debug, Clone, PartialEq)]
pub struct FeatureLayer {
    /// Its name.
    pub name: &'static str,
    /// One sentence about it.
    pub about: &'static str,
    /// The type of its geometries.
    pub geometry: GeometryType,
    /// The attributes.
    pub fields: &'static [Field],
    /// The features.
    pub features: Vec<Feature>,
}

/// The coordinate system of features.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Crs<'a> {
    /// Metres east and north of the origin of an invented world.
    Local,
    /// That of a map. Its EPSG code is known or not.
    Map(&'a Georeference),
}

/// What a file says of a coordinate system.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Definition {
    /// Its EPSG code, and its well-known text where that can be written.
    Epsg(u16, Option<String>),
    /// Well-known text of a system without a code.
    Wkt(String),
    /// Coordinates of an unknown system, in degrees or not.
    Unknown {
        /// Whether they are longitude and latitude.
        degrees: bool,
    },
}

impl Crs<'_> {
    /// What files say of it.
    pub fn definition(&self) -> Definition {
        let map = match self {
            Crs::Local => return Definition::Wkt(LOCAL_WKT.to_string()),
            Crs::Map(map) => map,
        };
        match (map.epsg(), map.wkt().ok()) {
            (Some(code), wkt) => Definition::Epsg(code, wkt),
            (None, Some(wkt)) => Definition::Wkt(wkt),
            (None, None) => Definition::Unknown { degrees: map.is_degrees() },
        }
    }
}

impl Value {
    /// A whole number where there is one.
    pub fn id(number: Option<u32>) -> Value {
        number.map_or(Value::Null, |number| Value::Integer(i64::from(number)))
    }
}

impl GeometryType {
    /// Whether each vertex has a height.
    pub fn has_z(self) -> bool {
        matches!(self, GeometryType::Point | GeometryType::LineZ)
    }
}

impl Geometry {
    /// Calls `visit` with east and north of every vertex.
    fn each(&mut self, mut visit: impl FnMut(&mut f64, &mut f64)) {
        match self {
            Geometry::Point([x, y, _]) => visit(x, y),
            Geometry::Line(points) => points.iter_mut().for_each(|[x, y, _]| visit(x, y)),
            Geometry::MultiPolygon(parts) => {
                parts.iter_mut().flatten().flatten().for_each(|[x, y]| visit(x, y));
            }
        }
    }

    /// The least and the greatest east and north: west, south, east, north. Empty geometries have none.
    pub fn bounds(&self) -> Option<[f64; 4]> {
        let mut bounds: Option<[f64; 4]> = None;
        let mut add = |x: f64, y: f64| {
            let [w, s, e, n] = bounds.unwrap_or([x, y, x, y]);
            bounds = Some([w.min(x), s.min(y), e.max(x), n.max(y)]);
        };
        match self {
            Geometry::Point([x, y, _]) => add(*x, *y),
            Geometry::Line(points) => points.iter().for_each(|[x, y, _]| add(*x, *y)),
            // Holes lie within the outer ring.
            Geometry::MultiPolygon(parts) => {
                parts.iter().filter_map(|part| part.first()).flatten().for_each(|[x, y]| add(*x, *y));
            }
        }
        bounds
    }

    /// How many vertices it has.
    pub fn vertices(&self) -> usize {
        match self {
            Geometry::Point(_) => 1,
            Geometry::Line(points) => points.len(),
            Geometry::MultiPolygon(parts) => parts.iter().flatten().map(Vec::len).sum(),
        }
    }
}

impl FeatureLayer {
    /// Turns metres east and south of the world's origin into map coordinates: those of `map`, else metres east and north.
    pub fn place(&mut self, map: Option<&Georeference>) {
        for feature in &mut self.features {
            feature.geometry.each(|x, y| [*x, *y] = map.map_or([*x, -*y], |map| map.at(*x, *y)));
        }
    }

    /// What holds all features: west, south, east, north.
    pub fn bounds(&self) -> Option<[f64; 4]> {
        self.features.iter().filter_map(|feature| feature.geometry.bounds()).reduce(join)
    }
}

/// The length of a line in the plane.
pub fn length(points: &[[f64; 3]]) -> f64 {
    points.windows(2).map(|pair| libm::hypot(pair[1][0] - pair[0][0], pair[1][1] - pair[0][1])).sum()
}

/// What holds two bounds.
pub fn join(a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
    [a[0].min(b[0]), a[1].min(b[1]), a[2].max(b[2]), a[3].max(b[3])]
}

/// The name of a world's own coordinate system.
pub const LOCAL_NAME: &str = "local metres";

/// A coordinate system of metres that is nowhere on Earth, as WKT 2 (ISO 19162).
pub const LOCAL_WKT: &str = concat!(
    r#"ENGCRS["local metres",EDATUM["origin of the world"],CS[Cartesian,2],"#,
    r#"AXIS["easting",east],AXIS["northing",north],LENGTHUNIT["metre",1]]"#
);

/// What the tests of this crate and of those above it share.
#[doc(hidden)]
pub mod samples {
    use super::*;

    const FIELDS: &[Field] = &[
        Field { name: "id", kind: FieldType::Integer, about: "number" },
        Field { name: "area", kind: FieldType::Real, about: "area in m^2" },
        Field { name: "closed", kind: FieldType::Boolean, about: "whether it is" },
        Field { name: "ends_in", kind: FieldType::Text, about: "where" },
    ];

    /// So many features of a type, of different lengths, some of them long.
    pub fn layer(name: &'static str, geometry: GeometryType, count: usize) -> FeatureLayer {
        let feature = |k: usize| {
            let (x, y) = ((k * 37 % 101) as f64 * 10.0, (k * 53 % 97) as f64 * 10.0);
            let points = 2 + if k % 50 == 7 { 400 } else { k % 9 };
            let line = || (0..points).map(|i| [x + i as f64, y + (i % 3) as f64, 100.0 - i as f64]).collect();
            let ring = |r: f64| vec![[x, y], [x + r, y], [x + r, y + r], [x, y + r], [x, y]];
            let hole = |r: f64| ring(r).into_iter().rev().map(|[u, v]| [u + 1.0, v + 1.0]).collect::<Ring>();
            Feature {
                geometry: match geometry {
                    GeometryType::Point => Geometry::Point([x, y, k as f64]),
                    GeometryType::Line | GeometryType::LineZ => Geometry::Line(line()),
                    GeometryType::MultiPolygon => Geometry::MultiPolygon(vec![vec![ring(8.0), hole(2.0)]]),
                },
                values: vec![
                    Value::Integer(k as i64 + 1),
                    if k.is_multiple_of(5) { Value::Real(f64::NAN) } else { Value::Real(k as f64 * 1.5) },
                    Value::Boolean(k.is_multiple_of(2)),
                    if k.is_multiple_of(3) { Value::Null } else { Value::Text("sea") },
                ],
            }
        };
        FeatureLayer { name, about: "a test", geometry, fields: FIELDS, features: (0..count).map(feature).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn features_lie_on_the_map_with_north_up() {
        let mut layer = samples::layer("a", GeometryType::LineZ, 3);
        layer.place(None);
        let bounds = layer.bounds().unwrap();
        assert!(bounds[3] <= 0.0 && bounds[1] < bounds[3], "{bounds:?}");
        let map = Georeference { origin: [100.0, 2000.0], per_metre: [2.0, 2.0], keys: None };
        let mut point = samples::layer("a", GeometryType::Point, 2);
        point.place(Some(&map));
        assert_eq!(point.features[1].geometry, Geometry::Point([100.0 + 740.0, 2000.0 - 1060.0, 1.0]));
        assert_eq!(samples::layer("a", GeometryType::MultiPolygon, 0).bounds(), None);
    }
}
