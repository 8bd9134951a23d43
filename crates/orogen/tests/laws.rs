//! The laws every node obeys, tested over all of them: a new node joins by existing.

use orogen::declare::Input;
use orogen::field::{add::Add, constant::Constant, fbm::Fbm, perlin::Perlin, transform::Transform, warp::Warp};
use orogen::filter::blur::Blur;
use orogen::node::Node;
use orogen::op::Op;
use orogen::plan::planner::Step;
use orogen::solver::normalise::Normalise;
use orogen::value::{Spanned, Value};
use orogen::{Grid, Options, Progress, Recipe, Window, World, WorldSpec};

/// A small deterministic generator for test inputs (splitmix64).
struct Random(u64);

impl Random {
    fn below(&mut self, n: u64) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        (z ^ (z >> 31)) % n
    }
}

/// The node alone: each input a noise of its own, lengths fitted so that a small world shows every effect.
fn recipe_of(node: &Node, world: WorldSpec, masked: bool) -> Recipe {
    let mut node = node.clone();
    let mut recipe = Recipe::new(world);
    let spec = node.spec();
    for (i, param) in spec.params.iter().enumerate() {
        let pair = |a: f64, b: f64| Value::List([a, b].map(|n| Spanned::unplaced(Value::Number(n))).into());
        let fitted = match (spec.op, param.name) {
            ("blur", "radius") => Value::Number(3.7 * world.cell),
            ("bake", "cell") => Value::Number(2.5 * world.cell),
            ("radial", "radius") => Value::Number(40.0 * world.cell),
            ("transform", "angle") => Value::Number(33.0),
            ("transform", "offset") => pair(17.3 * world.cell, -5.1 * world.cell),
            (_, "wavelength" | "width" | "length" | "strength") => Value::Number(11.3 * world.cell),
            _ => continue,
        };
        node.set_param(i, &fitted).unwrap();
    }
    for (i, input) in spec.inputs.iter().enumerate() {
        let name = format!("in{i}");
        let noise = Fbm { seed: i as u64, wavelength: 9.0 * world.cell, octaves: 3, ..Default::default() };
        recipe.add(&name, noise);
        // A filter below the node under test puts halos on top of halos.
        if input.name == "source" {
            recipe.add("soft", Blur { source: Input::from(&name), radius: 1.2 * world.cell });
            node.set_input(i, Input::from("soft"));
        } else {
            node.set_input(i, Input::Node(name));
        }
    }
    if masked {
        recipe.add("mask", Perlin { seed: 99, wavelength: 7.0 * world.cell });
        recipe.add_masked("node", node, "mask");
    } else {
        recipe.add("node", node);
    }
    recipe.output("height", "node");
    recipe
}

fn world_of(cell: f64) -> WorldSpec {
    WorldSpec { seed: 42, size: Some([96.0 * cell, 80.0 * cell]), cell, sea_level: 0.0 }
}

fn open(recipe: &Recipe, threads: usize) -> World {
    World::with_options(recipe.clone(), Options { threads: Some(threads), ..Options::default() })
        .unwrap_or_else(|error| panic!("{error}\n{}", recipe.to_toml()))
}

fn same_bits(name: &str, whole: &Grid, tile: &Grid) {
    let crop = whole.crop(tile.window()).expect("the tile is part of the whole");
    for (k, (a, b)) in crop.data().iter().zip(tile.data()).enumerate() {
        let (i, j) = (k % tile.width(), k / tile.width());
        assert_eq!(a.to_bits(), b.to_bits(), "{name}: {a} in the whole, {b} in {:?} at ({i}, {j})", tile.window());
    }
}

/// Tile == crop for one recipe: the whole against tiles of several sizes and offsets, thread counts, fresh and warm.
fn tiles_equal_crop(name: &str, recipe: &Recipe, cell: f64) {
    let whole_window = Window::new(97, 81, cell);
    let whole = open(recipe, 2).window("height", &whole_window).unwrap();
    assert!(whole.data().iter().all(|sample| sample.is_finite()), "{name} makes numbers");
    let warm = open(recipe, 1);
    let mut random = Random(name.len() as u64);
    for size in [1usize, 2, 7, 33, 64] {
        for _ in 0..2 {
            let x = random.below((97 - size) as u64 + 1) as i64;
            let y = random.below((81 - size) as u64 + 1) as i64;
            let tile = Window::new(size, size, cell).at(x, y);
            same_bits(name, &whole, &warm.window("height", &tile).unwrap());
        }
    }
    let tile = Window::new(31, 17, cell).at(13, 44);
    same_bits(name, &whole, &open(recipe, 2).window("height", &tile).unwrap());
    // A point on the lattice is the sample there.
    let (i, j) = (random.below(97) as usize, random.below(81) as usize);
    let point = warm.height(whole_window.east(i), whole_window.south(j)).unwrap();
    assert_eq!(point.to_bits(), whole.get(i, j).to_bits(), "{name}: point ({i}, {j})");
}

#[test]
fn tile_equals_crop_for_every_node() {
    for cell in [10.24, 0.1, 1.0 / 3.0] {
        for node in Node::all() {
            for masked in [false, true] {
                let recipe = recipe_of(&node, world_of(cell), masked);
                let name = format!("{}{} at {cell}", node.spec().op, if masked { " masked" } else { "" });
                tiles_equal_crop(&name, &recipe, cell);
            }
        }
    }
}

#[test]
fn every_node_can_be_warped_and_turned() {
    for node in Node::all() {
        let world = world_of(30.0);
        let from = recipe_of(&node, world, false);
        let mut recipe = Recipe::new(world);
        for named in from.nodes() {
            recipe.add_masked(&named.name, named.node.clone(), named.mask.clone());
        }
        let noise = |seed| Fbm { seed, wavelength: 300.0, octaves: 2, ..Default::default() };
        recipe.add("wx", noise(1)).add("wy", noise(2));
        recipe.add("warped", Warp { source: "node".into(), x: "wx".into(), y: "wy".into(), strength: 95.0 });
        let turned = Transform { source: "warped".into(), offset: [200.0, -77.0], scale: 1.5, angle: 25.0 };
        recipe.add("turned", turned);
        recipe.add("sum", Add { a: "turned".into(), b: "warped".into() });
        recipe.output("height", "sum");
        tiles_equal_crop(&format!("warped {}", node.spec().op), &recipe, 30.0);
    }
}

#[test]
fn unbounded_worlds_agree_far_out_and_below_zero() {
    for node in Node::all() {
        if matches!(node.op(), Op::Solver(_)) || matches!(node.op(), Op::Field(field) if field.needs_bounds()) {
            continue;
        }
        let world = WorldSpec { seed: 3, size: None, cell: 10.24, sea_level: 0.0 };
        let recipe = recipe_of(&node, world, false);
        for (x, y) in [(-40, -17), (1_000_003, -999_999_937), (97_656_250, 5)] {
            let window = Window::new(40, 30, 10.24).at(x, y);
            let whole = open(&recipe, 2).window("height", &window).unwrap();
            let tile = Window::new(9, 11, 10.24).at(x + 21, y + 6);
            same_bits(node.spec().op, &whole, &open(&recipe, 1).window("height", &tile).unwrap());
        }
    }
}

#[test]
fn fields_agree_where_two_resolutions_share_samples() {
    for node in Node::all().into_iter().filter(|node| matches!(node.op(), Op::Field(_))) {
        let from = recipe_of(&node, world_of(8.0), false);
        let mut recipe = Recipe::new(from.world);
        for named in from.nodes().iter().filter(|named| named.name != "soft") {
            let mut node = named.node.clone();
            for i in 0..node.spec().inputs.len() {
                // The blur is a filter, whose result depends on the cell: read what it blurs.
                if *node.input(i) == Input::from("soft") {
                    node.set_input(i, Input::Node(format!("in{i}")));
                }
            }
            recipe.add(&named.name, node);
        }
        recipe.output("height", "node");
        let world = open(&recipe, 2);
        let fine = world.window("height", &Window::new(64, 64, 4.0)).unwrap();
        let coarse = world.window("height", &Window::new(32, 32, 8.0)).unwrap();
        for (j, i) in (0..32).flat_map(|j| (0..32).map(move |i| (j, i))) {
            let (a, b) = (fine.get(2 * i, 2 * j), coarse.get(i, j));
            assert_eq!(a.to_bits(), b.to_bits(), "{} at ({i}, {j})", node.spec().op);
        }
    }
}

#[test]
fn forty_diamonds_cost_forty_evaluations() {
    let mut recipe = Recipe::new(WorldSpec::default());
    recipe.add("n0", Constant { value: 1.0 });
    for i in 1..=40 {
        let before = format!("n{}", i - 1);
        recipe.add(&format!("n{i}"), Add { a: (&before).into(), b: (&before).into() });
    }
    recipe.output("height", "n40");
    let world = open(&recipe, 1);
    let plan = world.plan(&["height"], &Window::new(16, 16, 10.0)).unwrap();
    let [Step::Fill { program, .. }] = plan.steps.as_slice() else { panic!("one fill") };
    assert_eq!(program.instructions.len(), 41);
    assert!(program.registers <= 2, "{} registers", program.registers);
    assert_eq!(world.height(0.0, 0.0).unwrap(), (1u64 << 40) as f32);
}

#[test]
fn a_chain_of_ten_thousand_nodes_runs() {
    // On a thread with a small stack: nothing may recurse along the chain.
    let work = || {
        let mut recipe = Recipe::new(WorldSpec::default());
        recipe.add("n0", Perlin::default());
        for i in 1..10_000 {
            let before = format!("n{}", i - 1);
            recipe.add(&format!("n{i}"), Add { a: (&before).into(), b: 1.0.into() });
        }
        recipe.output("height", "n9999");
        let again = Recipe::parse(&recipe.to_toml(), "chain.toml").unwrap();
        assert_eq!(recipe, again);
        let world = open(&again, 1);
        assert_eq!(world.window("height", &Window::new(8, 8, 10.0)).unwrap().get(0, 0), 9999.0);
    };
    std::thread::Builder::new().stack_size(512 << 10).spawn(work).unwrap().join().unwrap();
}

#[test]
fn warps_within_warps_are_refused_before_they_explode() {
    let mut recipe = Recipe::new(WorldSpec::default());
    recipe.add("n0", Perlin::default());
    for i in 1..40 {
        let before = &format!("n{}", i - 1);
        let warp = Warp { source: before.into(), x: before.into(), y: before.into(), ..Default::default() };
        recipe.add(&format!("n{i}"), warp);
    }
    recipe.output("height", "n39");
    let error = open(&recipe, 1).window("height", &Window::new(8, 8, 10.0)).unwrap_err();
    assert!(error.to_string().contains("warps of warps multiply"), "{error}");
}

#[test]
fn a_zero_displacement_changes_nothing() {
    for op in ["fbm", "blur", "slope", "normalise", "bake"] {
        let world = world_of(1.0 / 3.0);
        let mut recipe = recipe_of(&Node::named(op).unwrap(), world, false);
        recipe.add("still", Warp { source: "node".into(), x: 0.0.into(), y: 0.0.into(), strength: 10.0 });
        recipe.output("still", "still");
        let window = Window::new(50, 40, world.cell).at(3, 5);
        let grids = open(&recipe, 2).grids(&["height", "still"], &window, &Progress::none()).unwrap();
        same_bits(op, &grids[0], &grids[1]);
    }
}

#[test]
fn names_and_order_change_nothing() {
    let make = |a: &str, b: &str, swap: bool| {
        let noise = format!("[nodes.{a}]\nop = \"fbm\"\nseed = 5\nwavelength = 120\n");
        let stretch = format!("[nodes.{b}]\nop = \"normalise\"\nsource = \"{a}\"\n");
        let nodes = if swap { format!("{stretch}{noise}") } else { format!("{noise}{stretch}") };
        let text = format!("orogen = 1\n[world]\nsize = 1000\ncell = 10\n{nodes}[outputs]\nheight = \"{b}\"\n");
        let world = World::open(Recipe::parse(&text, "t").unwrap()).unwrap();
        world.window("height", &Window::new(40, 40, 10.0)).unwrap()
    };
    let first = make("a", "b", false);
    assert_eq!(first, make("zebra", "yak", true));
    assert_eq!(first, make("a", "b", true));
}

#[test]
fn normalise_meets_its_range_over_the_world() {
    let mut recipe = Recipe::new(world_of(7.0));
    recipe.add("noise", Fbm { wavelength: 90.0, ..Default::default() });
    recipe.add("land", Normalise { source: "noise".into(), low: -250.0, high: 1234.0 });
    recipe.output("height", "land");
    let grid = open(&recipe, 2).window("height", &Window::new(97, 81, 7.0)).unwrap();
    let low = grid.data().iter().copied().fold(f32::MAX, f32::min);
    let high = grid.data().iter().copied().fold(f32::MIN, f32::max);
    assert_eq!(low, -250.0);
    assert!((high - 1234.0).abs() < 1e-3, "{high}");
}

#[test]
fn dear_sources_of_a_filter_are_made_once() {
    // height and its slope in one layer: the fbm is made for the slope's halo and read again for the sum.
    let text = "orogen = 1\n[nodes.a]\nop = \"fbm\"\n[nodes.s]\nop = \"slope\"\nsource = \"a\"\n\
                [nodes.z]\nop = \"add\"\na = \"a\"\nb = \"s\"\n[outputs]\nheight = \"z\"\n";
    let world = World::open(Recipe::parse(text, "t").unwrap()).unwrap();
    let plan = world.plan(&["height"], &Window::new(16, 16, 10.0)).unwrap();
    let fields: usize = plan
        .steps
        .iter()
        .map(|step| match step {
            Step::Fill { program, .. } => program
                .instructions
                .iter()
                .filter(|i| matches!(i, orogen::plan::program::Instruction::Field { node: 0, .. }))
                .count(),
            Step::Apply { .. } => 0,
        })
        .sum();
    assert_eq!(fields, 1, "{}", world.explain(&plan));
}

#[test]
fn a_plan_is_a_value_that_can_be_sent() {
    let text = "orogen = 1\n[world]\nsize = 1000\ncell = 10\n[nodes.a]\nop = \"fbm\"\n[nodes.b]\nop = \"blur\"\nsource = \"a\"\n\
                [nodes.z]\nop = \"normalise\"\nsource = \"b\"\n[outputs]\nheight = \"z\"\n";
    let world = World::open(Recipe::parse(text, "t").unwrap()).unwrap();
    let window = Window::new(20, 20, 10.0).at(5, 5);
    let plan = world.plan(&["height"], &window).unwrap();
    let sent = serde_json::to_string(&plan).unwrap();
    let came = serde_json::from_str(&sent).unwrap();
    assert_eq!(plan, came);
    assert_eq!(world.run(&came, &Progress::none()).unwrap()[0], world.window("height", &window).unwrap());
}
