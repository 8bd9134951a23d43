//! Vector features as GIS formats store them: points, lines and polygons with attributes.

use super::dem::Georeference;
use orogen_codec::format::features;

pub use orogen_codec::format::coordinates::join;
pub use orogen_codec::format::features::{Feature, Field, FieldType, Geometry, GeometryType, Ring, Value, length};

/// A layer of features.
#[derive(Debug, Clone, PartialEq)]
pub struct FeatureLayer {
    /// The name.
    pub name: &'static str,
    /// One sentence of description.
    pub about: &'static str,
    /// The type of the geometries.
    pub geometry: GeometryType,
    /// The attributes.
    pub fields: &'static [Field],
    /// The features.
    pub features: Vec<Feature>,
}

/// The coordinate system of features.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Crs<'a> {
    /// Metres east and north of the origin of a world that is not a real place.
    Local,
    /// The coordinate system of a map, with or without an EPSG code.
    Map(&'a Georeference),
}

/// The definition of a coordinate system in a file.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Definition {
    /// The EPSG code, and the well-known text if it can be written.
    Epsg(u16, Option<String>),
    /// Well-known text of a system without a code.
    Wkt(String),
    /// Coordinates in an unknown system.
    Unknown {
        /// Whether the coordinates are longitude and latitude in degrees.
        degrees: bool,
    },
}

impl Crs<'_> {
    /// The definition to write to files.
    #[must_use]
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

impl FeatureLayer {
    /// Converts metres east and south of the world's origin to coordinates of `map`, or without a map to metres east
    /// and north.
    pub fn place(&mut self, map: Option<&Georeference>) {
        features::place(&mut self.features, map.map(|map| (map.origin, map.per_metre)));
    }

    /// The bounds of all features: west, south, east, north.
    #[must_use]
    pub fn bounds(&self) -> Option<[f64; 4]> {
        features::bounds(&self.features)
    }
}

/// The name of a world's local coordinate system.
pub const LOCAL_NAME: &str = "local metres";

/// A local coordinate system in metres, as WKT 2 (ISO 19162).
pub const LOCAL_WKT: &str = concat!(
    r#"ENGCRS["local metres",EDATUM["origin of the world"],CS[Cartesian,2],"#,
    r#"AXIS["easting",east],AXIS["northing",north],LENGTHUNIT["metre",1]]"#
);

/// Helpers for the tests of this crate and of crates that depend on it.
#[doc(hidden)]
pub mod samples {
    use super::*;

    const FIELDS: &[Field] = &[
        Field { name: "id", kind: FieldType::Integer, about: "number" },
        Field { name: "area", kind: FieldType::Real, about: "area in m^2" },
        Field { name: "closed", kind: FieldType::Boolean, about: "whether it is" },
        Field { name: "ends_in", kind: FieldType::Text, about: "where" },
    ];

    /// `count` features of a type, of different lengths, some of them long.
    #[must_use]
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
                    if k.is_multiple_of(3) { Value::Null } else { Value::text("sea") },
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
        assert_eq!(map.metres(100.0 + 740.0, 2000.0 - 1060.0), [370.0, 530.0]);
        assert_eq!(samples::layer("a", GeometryType::MultiPolygon, 0).bounds(), None);
    }
}
