//! The text of the recipe.

use orogen_engine::value::toml_string;
use orogen_grid::grid::Window;
use orogen_grid::words::count;
use orogen_io::format::fmg::{FmgMap, Water};

use super::files;
use super::rasters::Rasters;

/// The parameter for the detail of the coast.
pub const DETAIL: &str = "coast_detail";

/// The cell of the finest level of valleys, in metres. Smaller maps have a smaller one.
const CELL: f64 = 60.0;

/// Number of halvings to the finest valleys, at least.
const HALVINGS: u32 = 2;

/// The cell of the finest detail, about, in metres.
const FINEST: f64 = 1.0;

/// Number of cells of the coarsest level between the shore and the land that is farthest from it, at most: farther land
/// has no way to the sea on that level.
const DEPTH: f64 = 24.0;

/// Detail of the coast, in distances between the cells of the map.
const WANDER: f64 = 0.7;

/// Wavelength of the detail of the coast, in distances between the cells of the map.
const WAVELENGTH: f64 = 2.0;

/// Heights above the first share of the highest cell are compressed by a logarithm; the second share is the height
/// above it at which they rise half as fast.
const COMPRESSED: [f64; 2] = [0.8, 0.4];

/// The numbers of a recipe.
#[derive(Debug, Clone, PartialEq)]
pub struct Template {
    folder: String,
    seed: u64,
    cell: f64,
    halvings: u32,
    details: u32,
    window: Window,
    has_rain: bool,
}

impl Template {
    /// The numbers for a map. `folder` is the name of the folder of its files, `seed` the seed in place of the map's.
    pub fn new(map: &FmgMap, rasters: &Rasters, folder: &str, seed: Option<u64>) -> Template {
        let land = map.sites.iter().filter(|site| site.water != Some(Water::Sea));
        let far = land.filter_map(|site| rasters.shore.nearest(site.at, f64::INFINITY)).map(|near| near.distance());
        let deep = far.fold(0.0, f64::max) / DEPTH;
        let wanted = map.spacing.max(deep);
        let smallest = wanted / f64::from(1u32 << HALVINGS);
        let cell = if smallest >= CELL { CELL } else { rounded(smallest) };
        let halvings = libm::log2(wanted / cell).round().clamp(1.0, 23.0) as u32;
        let halvings = if cell * f64::from(1u32 << halvings) < deep { halvings + 1 } else { halvings };
        Template {
            folder: folder.to_owned(),
            seed: seed.or(map.seed).unwrap_or(1).min(i64::MAX as u64),
            cell,
            halvings,
            details: libm::log2(cell / FINEST).round().clamp(0.0, 10.0) as u32,
            window: *rasters.heights.window(),
            has_rain: rasters.rain.is_some(),
        }
    }

    /// The cell of the finest level of valleys.
    pub fn cell(&self) -> f64 {
        self.cell
    }

    /// The cell of the coarsest level.
    pub fn coarsest(&self) -> f64 {
        self.cell * f64::from(1u32 << self.halvings)
    }

    /// The cell of the finest level.
    pub fn finest(&self) -> f64 {
        self.cell / f64::from(1u32 << self.details)
    }

    /// The recipe.
    pub fn text(&self, map: &FmgMap) -> String {
        let Template { folder, seed, cell, halvings, details, window, has_rain } = self;
        let name = if map.name.is_empty() { folder } else { &map.name };
        let about = toml_string(&format!("{name}: a world from a map of Azgaar's Fantasy Map Generator"));
        let file = |name: &str| toml_string(&format!("{folder}/{name}"));
        let [width, height] = map.size.map(decimal);
        let spacing = map.spacing;
        let kilometres = decimal((spacing / 100.0).round() / 10.0);
        let detail = decimal(rounded(WANDER * spacing));
        let most = decimal(rounded(4.0 * spacing));
        let wavelength = WAVELENGTH * spacing;
        let octaves = libm::log2(wavelength / (2.0 * self.finest())).ceil().clamp(4.0, 24.0);
        let wavelength = decimal(rounded(wavelength));
        let at = |index: i64| decimal(index as f64 * window.cell);
        let at = format!("[{}, {}]", at(window.x), at(window.y));
        let lands = map.sites.iter().filter(|site| site.water.is_none());
        let highest = lands.map(|site| site.height).fold(10.0, f64::max);
        let [limit, rest] = COMPRESSED.map(|share| decimal(rounded(share * highest)));
        let highest = decimal(highest.round());
        let (coast, heights, uplift) = (file(files::COAST), file(files::HEIGHTS), file(files::UPLIFT));
        let (rivers, places) = (file(files::RIVERS), file(files::PLACES));
        let river_keys = match map.rivers.len() {
            0 => String::new(),
            _ => format!(
                "# The rivers of the map, with the heights of their beds: every level leads them along these lines.\nrivers_file = {rivers}\nsmooth = true\n"
            ),
        };
        let lake_count = match map.lakes.len() {
            0 => "The map has no lakes; those of the land are its own.".to_owned(),
            lakes => format!(
                "The {} of the map ({}) are land here, because this op has lakes of its own only.\n\
                 # To make one a sea at 0 m, copy its polygon into coast.geojson: it becomes a hole.",
                count(lakes, "lake"),
                files::LAKES
            ),
        };
        let (rain_nodes, rain_key) = match has_rain {
            true => (
                format!(
                    "\n# Precipitation of the map as a factor of the rain: 1 for 1000 mm a year.\n\
                     [nodes.rain_map]\nop = \"dem\"\npath = {}\nat = {at}\n\n\
                     [nodes.rain]\nop = \"clamp\"\nsource = \"rain_map\"\nlow = 0.05\nhigh = 10.0\n",
                    file(files::RAIN)
                ),
                "rain = \"rain\"\n",
            ),
            false => (String::new(), ""),
        };
        format!(
            r#"#:schema orogen.schema.json
# {title}, made by `orogen new --map` from a map of Azgaar's Fantasy Map Generator.
# The files of the folder open in QGIS. Edit them, or the numbers below, and the world follows.
# A map with names: orogen map {folder}.toml --names {places} -o map.png
orogen = 1
about = {about}

# The cells of the map are {kilometres} km wide, and its coast is straight between them.
# With 0 the land has the drawn coast.
[parameters.{DETAIL}]
default = {detail}
unit = "m"
range = [0.0, {most}]
help = "How far the coast wanders about the drawn one"

[world]
seed = {seed}
size = [{width}, {height}]
cell = {cell}
sea_level = 0.0

# The drawn land. At the border of the map it goes on beyond it.
[nodes.coast]
op = "polygon"
file = {coast}

# Bays and capes, -1 to 1.
[nodes.wander]
op = "fbm"
seed = 5
wavelength = {wavelength}
octaves = {octaves}
gain = 0.6

# Distance to the shore, positive on land.
[nodes.shore]
op = "expr"
expr = "{DETAIL} * wander - coast.distance"

# Heights of the map, in metres.
[nodes.heights]
op = "dem"
path = {heights}
at = {at}

# Uplift for a kilometre of height. It was found by making the world coarsely and comparing it with the map, so that
# the land reaches the heights of the map.
[nodes.uplift_factor]
op = "dem"
path = {uplift}
at = {at}

[nodes.uplift]
op = "expr"
expr = "clamp(0.001 * max(heights, 10) * uplift_factor, 0.003, 8)"

# Hillsides are not steeper than 45 degrees however fast the land rises: mountains that are steeper on the map stay
# lower.
[nodes.stability]
op = "expr"
expr = "min(1, (2 / uplift)^0.3)"
{rain_nodes}
# {lake_count}
[nodes.land]
op = "continents"
shore = "shore"
uplift = "uplift"
stability_factor = "stability"
{rain_key}cell = {cell}
halvings = {halvings}
details = {details}
shore_details = {details}
basins = 0.0
lakes = 0.3
{river_keys}
# The highest cell of the map has {highest} m. Summits above {limit} m are compressed, so that they are not
# twice as high.
[nodes.height]
op = "expr"
expr = "land - max(land - {limit}, 0) + {rest} * log(1 + max(land - {limit}, 0) / {rest})"

[nodes.surface]
op = "expr"
expr = "water - max(water - {limit}, 0) + {rest} * log(1 + max(water - {limit}, 0) / {rest})"
water = "land.surface"

[outputs]
height = "height"
lakes = "land.lake"
surface = "surface"
flow = "land.flow"
receiver = "land.receiver"
river_width = "land.width"
river_depth = "land.depth"
floodplain = "land.floodplain"
sediment = "land.sediment"
"#,
            title = one_line(name),
            folder = one_line(folder),
            cell = decimal(*cell),
            octaves = octaves as u32,
        )
    }
}

/// A number with three significant digits.
fn rounded(number: f64) -> f64 {
    let power = 2.0 - libm::log10(number.abs().max(1e-300)).floor();
    // Powers of ten with a positive exponent are exact.
    match power >= 0.0 {
        true => (number * libm::pow(10.0, power)).round() / libm::pow(10.0, power),
        false => (number / libm::pow(10.0, -power)).round() * libm::pow(10.0, -power),
    }
}

/// A number as a float of TOML.
fn decimal(number: f64) -> String {
    format!("{number:?}")
}

/// A text for a comment.
fn one_line(text: &str) -> String {
    text.chars().map(|char| if char.is_control() { ' ' } else { char }).collect()
}
