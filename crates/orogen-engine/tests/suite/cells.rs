//! Solvers with their own cell.

use orogen_engine::declare::{Input, LinePoints, Param};
use orogen_engine::field::{Fbm, Multiply};
use orogen_engine::node::Node;
use orogen_engine::value::{Spanned, Value};
use orogen_engine::{Grid, Progress, Recipe, Window, World, WorldSpec};

const CELL: f64 = 10.0;

/// A solver of rough terrain in a world with the cell `cell`; the solver's own cell is `own`.
fn world_of(node: &Node, cell: f64, own: f64) -> World {
    let mut node = node.clone();
    let param = node.spec().params.iter().position(|param| param.name == "cell").unwrap();
    node.set_param(param, &Value::Number(own)).unwrap();
    node.set_input(0, "land".into());
    if node.spec().op == "dunes" {
        node.set_input(1, 3.0.into());
    }
    if let Some(volume) = node.spec().params.iter().position(|param| param.name == "volume") {
        let volumes = [1e4, 1e5].map(|volume| Spanned::unplaced(Value::Number(volume)));
        node.set_param(volume, &Value::List(volumes.into())).unwrap();
    }
    if let Some(places) = node.spec().params.iter().position(|param| param.name == "places") {
        let line = LinePoints::from(vec![[100.0, 100.0], [1000.0, 700.0]]);
        node.set_param(places, &line.write()).unwrap();
        // The sea would be half of the land.
        let sea = node.spec().params.iter().position(|param| param.name == "sea").unwrap();
        node.set_param(sea, &Value::Flag(false)).unwrap();
    }
    let spec = WorldSpec::default().with_seed(5).with_size(Some([1200.0, 880.0])).with_cell(cell);
    let mut recipe = Recipe::new(spec);
    recipe.add("noise", Fbm { seed: 3, wavelength: 300.0, octaves: 4, ..Fbm::default() });
    recipe.add("land", Multiply { a: "noise".into(), b: 200.0.into() });
    let layers = node.layers();
    recipe.add("node", node);
    for layer in layers {
        recipe.output(layer.name, Input::Node(format!("node.{}", layer.name)));
    }
    World::open(recipe).unwrap()
}

fn layers_of(world: &World, window: &Window) -> Vec<Grid> {
    let layers: Vec<String> = world.recipe().outputs().map(str::to_string).collect();
    let layers: Vec<&str> = layers.iter().map(String::as_str).collect();
    world.grids(&layers, window, &Progress::none()).unwrap()
}

/// A solver with its own cell, read at its samples, equals the solver in a world with this cell.
#[test]
fn a_solver_at_its_own_cell_is_that_of_a_coarser_world() {
    let mut checked = Vec::new();
    for node in Node::all() {
        let is_solver = node.margin().is_some();
        if !is_solver || !node.spec().params.iter().any(|param| param.name == "cell") {
            continue;
        }
        let op = node.spec().op;
        let window = Window::new(30, 22, 4.0 * CELL);
        let own = layers_of(&world_of(&node, CELL, 4.0 * CELL), &window);
        let coarse = layers_of(&world_of(&node, 4.0 * CELL, 0.0), &window);
        for (own, coarse) in own.iter().zip(&coarse) {
            assert_eq!(own.data(), coarse.data(), "`{op}`");
        }
        // Fields are the same at any cell, and shares of them nearly so.
        if op != "bake" && op != "select-share" {
            let fine = layers_of(&world_of(&node, CELL, 0.0), &window);
            assert!(own.iter().zip(&fine).any(|(own, fine)| own.data() != fine.data()), "`{op}` ignores its cell");
        }
        checked.push(op);
    }
    let expected = [
        "bake",
        "breach",
        "coast",
        "drainage",
        "dunes",
        "fill",
        "lakes",
        "lava",
        "orographic-rain",
        "rivers",
        "roads",
        "select-share",
        "stream-power",
    ];
    assert_eq!(checked, expected);
}
