//! The `[world]` of a recipe: its parameters, as they are declared, read and written.

use orogen_io::dem::square::metres_of_degrees;
use orogen_io::format::crs::registry::Crs;
use orogen_io::format::crs::unit::Unit;
use orogen_io::format::dem::Georeference;
use orogen_ops::declare::{Param, ParamSpec, Shape, read_param};
use orogen_ops::op::WorldParams;
use orogen_ops::value::Value;
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

/// Parameters of `world`.
pub static WORLD: &[ParamSpec] = &[
    ParamSpec {
        name: "seed",
        alias: "",
        doc: "The seed of the world. Every node's own seed is hashed with it.",
        unit: "",
        shape: Shape::Seed,
        range: [0.0, f64::INFINITY],
    },
    ParamSpec {
        name: "size",
        alias: "",
        doc: "Extent of the world to the east and south, [width, height], or one number for a square. Without it the world is \
              unbounded, and solvers cannot be used.",
        unit: "m",
        shape: Shape::Pair,
        range: [1e-3, 1e9],
    },
    ParamSpec {
        name: "cell",
        alias: "",
        doc: "Cell size of the world's own lattice, on which solvers work. Default: 1/1024 of the longer side, or 10 m in an \
              unbounded world.",
        unit: "m",
        shape: Shape::Number,
        range: [1e-4, 1e7],
    },
    ParamSpec { name: "sea_level", alias: "", doc: "Sea level.", unit: "m", shape: Shape::Number, range: [-1e6, 1e6] },
    ParamSpec {
        name: "crs",
        alias: "",
        doc: "Coordinate reference system of the world, as an EPSG code; it needs `origin`. It is written to GeoTIFF, GeoJSON and other \
              georeferenced files. Default: the system of the file that a node `dem` reads, else local metres.",
        unit: "",
        shape: Shape::Crs,
        range: [f64::NEG_INFINITY, f64::INFINITY],
    },
    ParamSpec {
        name: "origin",
        alias: "",
        doc: "Easting and northing of the world's north-west corner in the units of `crs`; longitude and latitude if these are degrees.",
        unit: "",
        shape: Shape::Pair,
        range: [-1e9, 1e9],
    },
];

/// The world's parameter with this name.
#[must_use]
pub fn world_param(name: &str) -> Option<&'static ParamSpec> {
    WORLD.iter().find(|spec| spec.name == name)
}

/// Reads one of the world's parameters.
pub fn read_world(spec: &ParamSpec, value: &Value, world: &mut WorldSpec) -> Result<(), String> {
    match spec.name {
        "seed" => world.seed = read_param(spec, value)?,
        "size" => {
            world.size = Some(match value.number() {
                Some(side) => read_param(spec, &[side, side].write())?,
                None => read_param(spec, value)?,
            });
        }
        "cell" => world.cell = read_param(spec, value)?,
        "crs" => match value {
            Value::Text(text) => world.crs = Some(text.parse().map_err(|why| format!("`crs`: {why}"))?),
            other => return Err(format!("`crs` must be {}, not {}", spec.expected(), other.describe())),
        },
        "origin" => world.origin = Some(read_param(spec, value)?),
        _ => world.sea_level = read_param(spec, value)?,
    }
    Ok(())
}

/// The world's parameters as values, in the order of [`WORLD`].
pub fn world_values(world: &WorldSpec) -> impl Iterator<Item = (&'static str, Value)> {
    let crs = world.crs.map(|crs| Value::Text(format!("EPSG:{}", crs.code())));
    let [size, origin] = [world.size, world.origin].map(|pair| pair.map(|pair| pair.write()));
    let values = [Some(world.seed.write()), size, Some(world.cell.write()), Some(world.sea_level.write()), crs, origin];
    WORLD.iter().zip(values).filter_map(|(spec, value)| Some((spec.name, value?)))
}
