//! Helpers for the tests: a recipe for every node.

pub mod water;

use orogen::declare::{Input, Param as _, Stroke, StrokeMode, Strokes};
use orogen::field::Remap;
use orogen::laws::{self, Laws};
use orogen::node::Node;
use orogen::value::{Spanned, Value};
use orogen::{Options, Recipe, World, WorldSpec};

/// Whether the tests write the expected values instead of comparing with them: `OROGEN_BLESS=1`.
pub fn bless() -> bool {
    let value = std::env::var_os("OROGEN_BLESS");
    assert!(
        value.as_ref().is_none_or(|value| value == "1"),
        "only OROGEN_BLESS=1 rewrites the committed files: set it to that, or unset it to compare with them"
    );
    value.is_some()
}

/// A small deterministic generator for test inputs (splitmix64).
pub struct Random(pub u64);

impl Random {
    pub fn below(&mut self, n: u64) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        (z ^ (z >> 31)) % n
    }

    /// A number from 0 to 1, excluding 1.
    pub fn share(&mut self) -> f64 {
        self.below(1 << 53) as f64 / (1u64 << 53) as f64
    }

    /// One of the given values.
    pub fn of<'a, T>(&mut self, all: &'a [T]) -> &'a T {
        &all[self.below(all.len() as u64) as usize]
    }
}

/// A file of heights for the `dem` node.
pub const DEM: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fuzz/corpus/dem/f32-tiles-deflate-p3.tif");

/// A gray picture for the `image` node.
pub const PICTURE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fuzz/corpus/dem/grey.png");

/// A network for the `learned` node.
pub const NETWORK: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../orogen-grid/src/learned/land.network");

/// Lines, areas and ridges for nodes that draw.
pub const DRAWINGS: [&str; 3] = [
    concat!(env!("CARGO_MANIFEST_DIR"), "/../../fuzz/corpus/drawing/lines.geojson"),
    concat!(env!("CARGO_MANIFEST_DIR"), "/../../fuzz/corpus/drawing/areas.geojson"),
    concat!(env!("CARGO_MANIFEST_DIR"), "/../../fuzz/corpus/drawing/ridges.geojson"),
];

/// Two lines or rings for the nodes that draw, in a small world: the second one crosses the first.
fn drawing(cell: f64) -> Value {
    let list = |items: Vec<Value>| Value::List(items.into_iter().map(Spanned::unplaced).collect());
    let line = |points: &[[f64; 3]]| {
        let points = points.iter().map(|[x, y, z]| list([x * cell, y * cell, *z].map(Value::Number).into()));
        list(points.collect())
    };
    let first = [[11.3, 9.1, 4.0], [60.0, 20.7, 7.5], [81.9, 66.0, 3.0], [40.2, 41.0, -2.0], [15.5, 70.3, 1.0]];
    let second = [[30.0, 15.0, 8.0], [90.4, 31.2, 5.0], [52.6, 77.7, 6.0]];
    list(vec![line(&first), line(&second)])
}

/// Strokes of every mode for the node that paints, in a small world. They cross each other and themselves.
fn strokes(cell: f64) -> Strokes {
    let stroke = |points: &[[f64; 2]], radius: f64, hardness: f64, mode: StrokeMode, value: f64| Stroke {
        points: points.iter().map(|point| point.map(|part| part * cell)).collect(),
        radius: radius * cell,
        hardness,
        mode,
        value,
        strength: 0.9,
    };
    let loop_ = [[12.0, 9.3], [55.2, 20.7], [70.9, 61.0], [30.2, 52.0], [48.5, 8.3]];
    Strokes::from(vec![
        stroke(&loop_, 6.3, 0.4, StrokeMode::Add, 0.7),
        stroke(&[[20.0, 60.5], [80.4, 30.2], [90.0, 75.0]], 9.7, 0.0, StrokeMode::Set, -0.6),
        stroke(&[[50.3, 45.1]], 14.2, 1.0, StrokeMode::Erase, 1.0),
        stroke(&[[40.0, 35.0], [44.0, 62.0]], 5.0, 0.6, StrokeMode::Add, -1.1),
    ])
}

/// A recipe of the node with a different noise for each input: see [`laws::recipe_of`]. Lengths are fitted so that a
/// small world shows every effect.
pub fn recipe_of(node: &Node, world: WorldSpec, masked: bool) -> Recipe {
    let mut node = node.clone();
    let spec = node.spec();
    for (i, param) in spec.params.iter().enumerate() {
        let pair = |a: f64, b: f64| Value::List([a, b].map(|n| Spanned::unplaced(Value::Number(n))).into());
        let fitted = match (spec.op, param.name) {
            ("path" | "polygon" | "meanders", "points") => drawing(world.cell),
            ("meanders", "width") => Value::Number(3.1 * world.cell),
            ("meanders", "depth") => Value::Number(0.2 * world.cell),
            ("paint", "strokes") => strokes(world.cell).write(),
            ("path" | "polygon", "smooth") => Value::Flag(true),
            ("path" | "polygon", "tolerance") => Value::Number(0.01 * world.cell),
            ("path" | "polygon", "falloff") => Value::Number(6.7 * world.cell),
            // Few levels, with the finest near the cell, and shores within the world.
            ("continents", "cell") => Value::Number(1.7 * world.cell),
            ("continents", "halvings") => Value::Integer(3),
            ("continents", "size") => Value::Number(0.01),
            // Fewer than the number of candidates.
            ("select-share", "share") => Value::Number(0.05),
            ("blur", "radius") => Value::Number(3.7 * world.cell),
            ("bake", "cell") => Value::Number(2.5 * world.cell),
            ("resample", "cell") => Value::Number(1.7 * world.cell),
            ("thermal", "talus_angle") => Value::Number(1.0),
            (_, "iterations") => Value::Integer(3),
            ("droplets", "batches") => Value::Integer(2),
            ("droplets", "lifetime") => Value::Number(7.5 * world.cell),
            ("droplets", "radius") => Value::Number(2.2 * world.cell),
            ("droplets", "density") => Value::Number(1e6 / (world.cell * world.cell)),
            ("glaciate", "max_width") => Value::Number(5.0 * world.cell),
            // Reads fewer samples around.
            ("hillslopes", "rivers") => Value::Integer(8),
            // Four on a hundred samples, on ground of any slope.
            ("dolines", "density") => Value::Number((0.04e6 / (world.cell * world.cell)).min(1e6)),
            ("dolines", "diameters") => pair(2.3 * world.cell, 11.0 * world.cell),
            ("dolines", "cluster_distance") => Value::Number(20.0 * world.cell),
            ("dolines", "max_slope") => Value::Number(90.0),
            ("craters", "diameters") => pair(2.3 * world.cell, 50.0 * world.cell),
            ("craters", "transition") => Value::Number(20.0 * world.cell),
            ("craters", "diffusion") => Value::Number(5.0 * world.cell * world.cell),
            ("dunes", "wavelength") => Value::Number(9.0 * world.cell),
            // Some thirty steps.
            ("dunes", "years") => Value::Number(0.05 * world.cell * world.cell),
            ("dunes", "wind_spread") => Value::Number(40.0),
            // Flows of some ten cells, of which a few leave the world.
            ("lava", "volume") => {
                let cube = world.cell * world.cell * world.cell;
                pair(2.0 * cube, 300.0 * cube)
            }
            ("lava", "effusion") => Value::Number(0.1 * world.cell),
            ("lava", "yield_strength") => Value::Number(2000.0 * world.cell),
            ("lava", "caldera") => Value::Number(9.0 * world.cell),
            ("roads", "places") => drawing(world.cell),
            ("roads", "width") => Value::Number(2.3 * world.cell),
            ("roads", "spacing") => Value::Number(2.0 * world.cell),
            ("roads", "radius" | "slope_width") => Value::Number(4.0 * world.cell),
            ("roads", "longest_bridge" | "longest_tunnel") => Value::Number(60.0 * world.cell),
            // The sea would be half of the land.
            ("roads", "sea") => Value::Flag(false),
            ("select-height", "range") => pair(-0.1, 0.1),
            ("select-height", "falloff") => pair(0.3, 0.2),
            ("select-flow", "range") => pair(0.02, 0.1),
            ("select-flow", "falloff") => pair(2.0, 1.0),
            ("select-slope", "range") => pair(1.0, 2.0),
            ("select-slope", "falloff") => pair(0.7, 40.0),
            ("select-aspect", "least_slope") => Value::Number(1.0),
            ("select-curvature", "scale") => Value::Number(2.1 * world.cell),
            ("select-curvature", "range") => pair(0.0, 1e-4),
            ("select-curvature", "falloff") => pair(1e-4, 1e-2),
            ("distance", "threshold") => Value::Number(0.2),
            ("distance", "reach") => Value::Number(8.3 * world.cell),
            ("topographic-position", "radius") => Value::Number(4.4 * world.cell),
            ("geomorphons", "reach") => Value::Number(6.3 * world.cell),
            // The noise rises by at most one metre, over many metres.
            ("geomorphons", "flat") => Value::Number(0.2),
            ("height-above-drainage", "stream") => Value::Number(40.0 * world.cell * world.cell),
            ("viewshed", "observer") => pair(40.3 * world.cell, 31.0 * world.cell),
            ("viewshed", "radius") => Value::Number(60.0 * world.cell),
            ("insolation", "days") => pair(80.0, 120.0),
            ("insolation", "step") => Value::Number(3.0),
            ("radial", "radius") => Value::Number(40.0 * world.cell),
            ("expr", "expr") => Value::Text(
                "mix(source, -other * 2, smoothstep(-0.5, 0.5, third)) + max(source, other)^2 - sin(third)".into(),
            ),
            ("dem", "path") => Value::Text(DEM.into()),
            ("image", "path") => Value::Text(PICTURE.into()),
            // 37 x 23 samples.
            ("exemplar", "path") => Value::Text(DEM.into()),
            ("exemplar", "cell") => Value::Number(1.7 * world.cell),
            ("exemplar", "rotate") => Value::Flag(true),
            ("dem", "at") => pair(17.3 * world.cell, -5.1 * world.cell),
            ("dem", "fade") => Value::Number(20.0 * world.cell),
            ("transform", "angle") => Value::Number(33.0),
            ("transform", "offset") => pair(17.3 * world.cell, -5.1 * world.cell),
            // A number of folds or a ratio, not a length.
            ("ping-pong" | "gullies", "strength") => continue,
            // An angle, not a length.
            ("select-aspect", "width") => continue,
            ("gullies", "step") => Value::Number(0.7 * world.cell),
            (_, "wavelength" | "width" | "length" | "strength") => Value::Number(11.3 * world.cell),
            _ => continue,
        };
        node.set_param(i, &fitted).unwrap();
    }
    let mut recipe = laws::recipe_of(&node, world, masked);
    if spec.op == "biome" {
        // The op reads temperatures and rain.
        recipe.add("warm", Remap { source: Input::from("in0"), to: [-20.0, 30.0], ..Remap::default() });
        recipe.add("wet", Remap { source: Input::from("in1"), to: [0.0, 3000.0], ..Remap::default() });
        recipe.change(|node| {
            if node.spec().op == spec.op {
                node.set_input(0, Input::from("warm"));
                node.set_input(1, Input::from("wet"));
            }
        });
    }
    if spec.op == "roads" {
        // Ponds, not half of the land.
        recipe.add("ponds", Remap { source: Input::from("in1"), to: [-2.0, 0.3], ..Remap::default() });
        recipe.change(|node| {
            if node.spec().op == spec.op {
                node.set_input(1, Input::from("ponds"));
            }
        });
    }
    // Ops that read codes of directions, 0 to 8, and the number of that input.
    let codes = match spec.op {
        "flow-direction" => Some(0),
        "glaciate" | "glaciers" => Some(1),
        _ => None,
    };
    if let Some(input) = codes {
        let (from, to) = ([-0.5, 0.5], [0.0, 8.5]);
        recipe.add("codes", Remap { source: Input::from("soft"), from, to, clamp: true });
        // The ice of glaciers, in m^2.
        recipe.add("ice", Remap { source: Input::from("in0"), to: [-2e6, 2e6], ..Remap::default() });
        recipe.change(|node| {
            if node.spec().op == spec.op {
                node.set_input(input, Input::from("codes"));
                if spec.inputs.get(2).is_some_and(|input| input.name == "ice") {
                    node.set_input(2, Input::from("ice"));
                }
            }
        });
    }
    recipe
}

/// The laws of a built-in op, in recipes of [`recipe_of`].
pub fn laws_of(node: &Node) -> Laws<'_> {
    Laws::in_recipes(node.clone(), |world, masked| recipe_of(node, world, masked))
}

pub fn world_of(cell: f64) -> WorldSpec {
    laws::world_of(cell)
}

pub fn open(recipe: &Recipe, threads: usize) -> World {
    World::with_options(recipe.clone(), Options { threads: Some(threads), ..Options::default() })
        .unwrap_or_else(|error| panic!("{error}\n{}", recipe.to_toml()))
}
