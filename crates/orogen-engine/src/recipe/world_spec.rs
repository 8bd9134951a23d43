//! The `[world]` of a recipe and its keys.

use super::table::key::Key;
use super::table::keys::Keys;
use super::table::part::OfKey;
use super::table::reader::{Table, ValueReader};
use orogen_io::dem::square::metres_of_degrees;
use orogen_io::format::crs::registry::Crs;
use orogen_io::format::crs::unit::Unit;
use orogen_io::format::dem::Georeference;
use orogen_ops::op::WorldParams;
use orogen_ops::value::{Spanned, Value};
use serde_json::{Value as Json, json};

/// The `[world]` of a recipe. Lengths are in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct WorldSpec {
    /// The seed of the world, which is hashed with every node's own seed.
    pub seed: u64,
    /// Extent east and south; `None` for an unbounded world.
    pub size: Option<[f64; 2]>,
    /// Distance between samples of the world's own lattice: the cell of solvers, and the default cell of requests.
    pub cell: f64,
    /// Height of the sea level.
    pub sea_level: f64,
    /// The map of the world; `None` for local metres, or for the map of a real place in the recipe.
    pub crs: Option<Crs>,
    /// East and north of the world's first sample, its north-west corner, in the units of `crs`.
    pub origin: Option<[f64; 2]>,
}

impl Default for WorldSpec {
    fn default() -> WorldSpec {
        WorldSpec { seed: 0, size: None, cell: 10.0, sea_level: 0.0, crs: None, origin: None }
    }
}

orogen_noise::builder!(
    WorldSpec: with_seed(seed: u64),
    with_size(size: Option<[f64; 2]>),
    with_cell(cell: f64),
    with_sea_level(sea_level: f64),
    with_crs(crs: Option<Crs>),
    with_origin(origin: Option<[f64; 2]>)
);

impl WorldSpec {
    /// The parameters of the world for ops.
    #[must_use]
    pub fn world_params(&self) -> WorldParams {
        WorldParams { seed: self.seed, size: self.size, cell: self.cell, sea_level: self.sea_level }
    }

    /// The position of the world on the map of its `crs`, if it has both that and an `origin`. In degrees, metres are
    /// converted with the length of a degree at the world's middle latitude.
    pub(super) fn georeference(&self) -> Option<Georeference> {
        let (crs, origin) = (self.crs?, self.origin?);
        let per_metre = match crs.unit() {
            Unit::Metres(unit) => [1.0 / unit; 2],
            unit @ (Unit::Degrees | Unit::Grads) => {
                let degrees = unit.degrees().unwrap_or(1.0);
                let half = self.size.map_or(0.0, |size| size[1] / 2.0);
                let middle = origin[1] * degrees - half / metres_of_degrees(origin[1] * degrees)[1];
                metres_of_degrees(middle).map(|metres| 1.0 / (metres * degrees))
            }
        };
        Some(Georeference { origin, per_metre, keys: Some(crs.keys()) })
    }
}

/// The keys of `[world]`.
pub static KEYS: Keys<WorldSpec> = Keys {
    needs: &[],
    parts: &[
        key!(WorldSpec.seed, "The seed of the world. Every node's own seed is hashed with it."),
        key!(
            WorldSpec.size,
            "Extent of the world to the east and south, [width, height], or one number for a square. Without it the \
             world is unbounded, and solvers cannot be used. Unit: m.",
            range [1e-3, 1e9], pair "[WIDTH, HEIGHT]", single true
        ),
        key!(
            WorldSpec.cell,
            "Cell size of the world's own lattice, on which solvers work. Default: 1/1024 of the longer side, or 10 m \
             in an unbounded world. Unit: m.",
            range [1e-4, 1e7]
        ),
        key!(WorldSpec.sea_level, "Sea level. Unit: m.", range [-1e6, 1e6]),
        key!(
            WorldSpec.crs,
            "Coordinate reference system of the world, as an EPSG code; it needs `origin`. It is written to GeoTIFF, \
             GeoJSON and other georeferenced files. Default: the system of the file that a node `dem` reads, else \
             local metres."
        ),
        key!(
            WorldSpec.origin,
            "Easting and northing of the world's north-west corner in the units of `crs`; longitude and latitude if \
             these are degrees.",
            range [-1e9, 1e9], pair "[EASTING, NORTHING]"
        ),
    ],
};

impl WorldSpec {
    /// Reads `[world]`.
    pub(super) fn read(value: &Spanned<Value>, values: &mut ValueReader) -> WorldSpec {
        let Some(entries) = values.table("`world`", value) else { return WorldSpec::default() };
        let table = Table { name: "`world`", span: &value.span, entries };
        let mut world = KEYS.read(&table, values, WorldSpec::default());
        if let Some([width, height]) = world.size.filter(|_| !table.has("cell")) {
            world.cell = width.max(height) / 1024.0;
        }
        world
    }
}

/// A coordinate reference system, by its EPSG code.
impl OfKey for Crs {
    fn schema(_: &Key) -> Json {
        json!({ "type": "string", "pattern": "^EPSG:[0-9]+$" })
    }

    fn read(key: &Key, value: &Spanned<Value>, values: &mut ValueReader) -> Option<Crs> {
        let name = key.name;
        let problem = match &value.value {
            Value::Text(text) => match text.parse() {
                Ok(crs) => return Some(crs),
                Err(why) => format!("`{name}`: {why}"),
            },
            other => {
                let found = other.describe();
                format!("`{name}` must be an EPSG code in quotes, such as \"EPSG:32632\", not {found}")
            }
        };
        values.diagnostic(&value.span, problem);
        None
    }

    fn write(&self, _: &Key) -> Option<Value> {
        Some(Value::Text(format!("EPSG:{}", self.code())))
    }
}
