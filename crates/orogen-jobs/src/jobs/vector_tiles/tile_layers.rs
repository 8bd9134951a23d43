//! The layers of vector tiles, and their attributes.

use orogen_io::format::features::{Feature, FeatureLayer, Field, FieldType, Value};

/// A layer of vector tiles.
pub struct TileLayerSpec {
    /// The name.
    pub name: &'static str,
    /// A one-line description.
    pub about: &'static str,
    /// The attributes.
    pub fields: &'static [TileField],
}

/// An attribute.
pub struct TileField {
    /// Name, type and description.
    pub field: Field,
    /// The name of the attribute of the exported layer that it is made from.
    of: &'static str,
}

const fn real(name: &'static str, of: &'static str, about: &'static str) -> TileField {
    TileField { field: Field { name, kind: FieldType::Real, about }, of }
}

const fn integer(name: &'static str, of: &'static str, about: &'static str) -> TileField {
    TileField { field: Field { name, kind: FieldType::Integer, about }, of }
}

/// Contours.
pub static CONTOURS: TileLayerSpec = TileLayerSpec {
    name: "contours",
    about: "contour lines, higher ground to their left",
    fields: &[
        real("elevation", "elevation", "height, m"),
        TileField {
            field: Field {
                name: "index",
                kind: FieldType::Boolean,
                about: "whether it is an index contour (every fifth contour)",
            },
            of: "index",
        },
    ],
};

/// Rivers.
pub static RIVERS: TileLayerSpec = TileLayerSpec {
    name: "rivers",
    about: "river reaches over land, downstream",
    fields: &[
        integer("strahler", "strahler", "Strahler order; none if a part of the catchment was not computed"),
        real("drainage_area", "drainage_area", "drainage area at the end of the reach, m^2"),
        real("discharge", "discharge", "mean discharge at the end of the reach, m^3/s"),
        real("width", "width", "width at the end of the reach, m"),
    ],
};

/// Lakes.
pub static LAKES: TileLayerSpec = TileLayerSpec {
    name: "lakes",
    about: "lakes, with islands as holes",
    fields: &[
        real("level", "level", "height of the surface, m"),
        real("area", "area", "area of the surface, m^2; only in worlds whose water is found at once"),
    ],
};

/// Summits.
pub static SUMMITS: TileLayerSpec = TileLayerSpec {
    name: "summits",
    about: "summits; in an unbounded world, points higher than all ground within a distance on the tile",
    fields: &[
        real("height", "height", "height, m"),
        real("prominence", "prominence", "prominence, m; only in a bounded world"),
        integer("rank", "id", "rank by prominence, from 1; only in a bounded world"),
    ],
};

/// Scattered objects.
pub static OBJECTS: TileLayerSpec = TileLayerSpec {
    name: "objects",
    about: "objects of the recipe's scatter, such as trees, at zooms at which they are not too many",
    fields: &[
        TileField { field: Field { name: "kind", kind: FieldType::Text, about: "name of the kind" }, of: "kind" },
        real("size", "size", "scale factor"),
        real("turn", "turn", "turn in degrees, clockwise seen from above"),
        real("height", "height", "height of the ground, m"),
    ],
};

/// All layers, those that cover others last.
pub static ALL: [&TileLayerSpec; 5] = [&LAKES, &CONTOURS, &RIVERS, &OBJECTS, &SUMMITS];

impl TileLayerSpec {
    /// The names of the attributes.
    #[must_use]
    pub fn names(&self) -> Vec<&'static str> {
        self.fields.iter().map(|field| field.field.name).collect()
    }

    /// The indices of the attributes among those of an exported layer.
    pub(super) fn columns(&self, layer: &FeatureLayer) -> Vec<Option<usize>> {
        self.fields.iter().map(|own| layer.fields.iter().position(|field| field.name == own.of)).collect()
    }
}

/// The values of a feature's attributes in these columns, without digits that only take space.
pub(super) fn values(feature: &Feature, columns: &[Option<usize>]) -> Vec<Value> {
    let of = |column: &Option<usize>| match column.and_then(|column| feature.values.get(column)) {
        Some(Value::Real(number)) => Value::Real(f64::from(*number as f32)),
        Some(value) => value.clone(),
        None => Value::Null,
    };
    columns.iter().map(of).collect()
}
