//! Invariants of all nodes. New nodes are included automatically.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test that fails panics")]

mod support;

use orogen::declare::Input;
use orogen::field::{add::Add, constant::Constant, fbm::Fbm, perlin::Perlin, transform::Transform, warp::Warp};
use orogen::filter::blur::Blur;
use orogen::node::Node;
use orogen::op::Op;
use orogen::plan::steps::{Plan, Step};
use orogen::solver::{bake::Bake, normalise::Normalise};
use orogen::{Grid, Progress, Recipe, Window, World, WorldSpec};
use support::{Random, open, recipe_of, world_of};

fn same_bits(name: &str, whole: &Grid, tile: &Grid) {
    let crop = whole.crop(tile.window()).expect("the tile is part of the whole");
    for (k, (a, b)) in crop.data().iter().zip(tile.data()).enumerate() {
        let (i, j) = (k % tile.width(), k / tile.width());
        assert_eq!(a.to_bits(), b.to_bits(), "{name}: {a} in the whole, {b} in {:?} at ({i}, {j})", tile.window());
    }
}

/// Tiles equal crops for every layer of one recipe: the whole raster against tiles of several sizes and offsets, with
/// several thread counts, cold and warm.
fn tiles_equal_crop(name: &str, recipe: &Recipe, cell: f64) {
    let whole_window = Window::new(97, 81, cell);
    let layers: Vec<&str> = recipe.outputs().collect();
    let all = |world: &World, window: &Window| world.grids(&layers, window, &Progress::none()).unwrap();
    let wholes = all(&open(recipe, 2), &whole_window);
    let warm = open(recipe, 1);
    let mut random = Random(name.len() as u64);
    let mut tiles = vec![(Window::new(31, 17, cell).at(13, 44), true)];
    tiles.push((whole_window, true));
    for size in [1usize, 2, 7, 33, 64] {
        for _ in 0..2 {
            let x = random.below((97 - size) as u64 + 1) as i64;
            let y = random.below((81 - size) as u64 + 1) as i64;
            tiles.push((Window::new(size, size, cell).at(x, y), false));
        }
    }
    for (tile, fresh) in tiles {
        let made = if fresh { all(&open(recipe, 2), &tile) } else { all(&warm, &tile) };
        for ((layer, whole), made) in layers.iter().zip(&wholes).zip(&made) {
            same_bits(&format!("{name}, {layer}"), whole, made);
        }
    }
    // A point on the grid has the value of the sample there.
    let (i, j) = (random.below(97) as usize, random.below(81) as usize);
    for (layer, whole) in layers.iter().zip(&wholes) {
        assert!(whole.data().iter().all(|sample| sample.is_finite()), "{name}, {layer}: makes numbers");
        let point = warm.points(layer, &[whole_window.east(i)], &[whole_window.south(j)]).unwrap()[0];
        assert_eq!(point.to_bits(), whole[(i, j)].to_bits(), "{name}, {layer}: point ({i}, {j})");
    }
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

/// A plan is plain data: a test can set all solutions to disk, and the tile size of their sources.
#[test]
fn every_node_is_the_same_from_disk_and_in_tiles_of_any_size() {
    for node in Node::all() {
        let cell = 1.0 / 3.0;
        let from = recipe_of(&node, world_of(cell), false);
        let mut recipe = Recipe::new(from.world);
        for named in from.nodes() {
            recipe.add_masked(&named.name, named.node.clone(), named.mask.clone());
        }
        // Warps of filters of solvers of the node.
        let noise = Fbm { seed: 8, wavelength: 20.0 * cell, octaves: 2, ..Default::default() };
        recipe.add("move", noise).add("kept", Bake { source: "node".into(), cell: 0.7 * cell });
        recipe.add("soft2", Blur { source: "kept".into(), radius: 1.1 * cell });
        recipe.add("last", Warp { source: "soft2".into(), x: "move".into(), y: "move".into(), strength: 9.0 * cell });
        recipe.output("height", "last").output("node", "node");
        let window = Window::new(60, 50, cell).at(30, 29);
        let layers = ["height", "node"];
        let expect = open(&recipe, 2).grids(&layers, &window, &Progress::none()).unwrap();
        for (side, threads, tile) in
            [(1 << 20, 1, window), (33, 2, window), (50, 2, Window::new(7, 1, cell).at(41, 77))]
        {
            let world = open(&recipe, threads);
            let mut plan = world.plan(&layers, &tile).unwrap();
            assert!(!plan.solves().is_empty());
            plan.solve_on_disk(side);
            for (whole, made) in expect.iter().zip(world.run(&plan, &Progress::none()).unwrap()) {
                same_bits(&format!("{} in tiles of {side}, on disk", node.spec().op), whole, &made);
            }
            // In memory again, from what is on disk.
            same_bits(node.spec().op, &expect[0], &world.window("height", &tile).unwrap());
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
        for layer in node.layers() {
            let [warped, turned, sum] = ["warped", "turned", "sum"].map(|what| format!("{what}-{}", layer.name));
            let source = Input::Node(format!("node.{}", layer.name));
            recipe.add(&warped, Warp { source, x: "wx".into(), y: "wy".into(), strength: 95.0 });
            let source = Input::from(&warped);
            recipe.add(&turned, Transform { source, offset: [200.0, -77.0], scale: 1.5, angle: 25.0 });
            recipe.add(&sum, Add { a: (&turned).into(), b: (&warped).into() });
            recipe.output(layer.name, &sum);
        }
        tiles_equal_crop(&format!("warped {}", node.spec().op), &recipe, 30.0);
    }
}

#[test]
fn unbounded_worlds_agree_far_out_and_below_zero() {
    for node in Node::all() {
        if matches!(node.op(), Op::Solver(_)) || matches!(node.op(), Op::Field(field) if field.needs_bounds()) {
            continue;
        }
        let world = WorldSpec { seed: 3, size: None, cell: 10.24, ..WorldSpec::default() };
        let recipe = recipe_of(&node, world, false);
        for (x, y) in [(-40, -17), (1_000_003, -999_999_937), (97_656_250, 5)] {
            let window = Window::new(40, 30, 10.24).at(x, y);
            let whole = open(&recipe, 2).window("height", &window).unwrap();
            let tile = Window::new(9, 11, 10.24).at(x + 21, y + 6);
            same_bits(node.spec().op, &whole, &open(&recipe, 1).window("height", &tile).unwrap());
        }
    }
}

/// The node and its inputs without the blur below them, because the result of a filter depends on the cell size.
fn unsoftened(from: &Recipe) -> Recipe {
    let mut recipe = Recipe::new(from.world);
    for named in from.nodes().iter().filter(|named| named.name != "soft") {
        let mut node = named.node.clone();
        for i in 0..node.inputs().len() {
            if *node.input(i) == Input::from("soft") {
                node.set_input(i, Input::Node(format!("in{i}")));
            }
        }
        recipe.add_masked(&named.name, node, named.mask.clone());
    }
    recipe.output("height", "node");
    recipe
}

#[test]
fn fields_agree_where_two_resolutions_share_samples() {
    for node in Node::all().into_iter().filter(|node| matches!(node.op(), Op::Field(_))) {
        let unbounded = !matches!(node.op(), Op::Field(field) if field.needs_bounds());
        for cell in [8.0, 10.24, 0.1, 1.0 / 3.0] {
            for (ratio, masked) in [(2usize, false), (4, true), (8, false)] {
                let sized = unsoftened(&recipe_of(&node, world_of(cell), masked));
                let mut free = sized.clone();
                if unbounded {
                    free.world.size = None;
                }
                let (bounded, free) = (open(&sized, 2), open(&free, 2));
                let mut places = vec![(&bounded, 0, 0)];
                if unbounded {
                    places.extend([(&free, -3, -11), (&free, 1_000_003, -999_999_937), (&free, -97_656_250, 5)]);
                }
                for (world, x, y) in places {
                    let coarse = Window::new(9, 9, cell).at(x, y);
                    let steps = 8 * ratio + 1;
                    let fine = Window::new(steps, steps, cell / ratio as f64).at(x * ratio as i64, y * ratio as i64);
                    let [coarse, fine] = [coarse, fine].map(|window| world.window("height", &window).unwrap());
                    for (j, i) in (0..9).flat_map(|j| (0..9).map(move |i| (j, i))) {
                        let (a, b) = (fine[(ratio * i, ratio * j)], coarse[(i, j)]);
                        let op = node.spec().op;
                        assert_eq!(a.to_bits(), b.to_bits(), "{op} at ({x} + {i}, {y} + {j}), {cell} m over {ratio}");
                    }
                }
            }
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
    let [Step::Fill { program, .. }] = plan.steps() else { panic!("one fill") };
    assert_eq!(program.instructions.len(), 41);
    assert!(program.registers <= 2, "{} registers", program.registers);
    assert_eq!(world.height(0.0, 0.0).unwrap(), (1u64 << 40) as f32);
}

#[test]
fn a_chain_of_ten_thousand_nodes_runs() {
    // On a thread with a small stack: no recursion along the chain.
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
        assert_eq!(world.window("height", &Window::new(8, 8, 10.0)).unwrap()[(0, 0)], 9999.0);
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
    assert!(error.to_string().contains("nested warps multiply"), "{error}");
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
    // height and its slope in one layer: the fbm is computed for the slope's halo and reused for the sum.
    let text = "orogen = 1\n[nodes.a]\nop = \"fbm\"\n[nodes.s]\nop = \"slope\"\nsource = \"a\"\n\
                [nodes.z]\nop = \"add\"\na = \"a\"\nb = \"s\"\n[outputs]\nheight = \"z\"\n";
    let world = World::open(Recipe::parse(text, "t").unwrap()).unwrap();
    let plan = world.plan(&["height"], &Window::new(16, 16, 10.0)).unwrap();
    let fields: usize = plan
        .steps()
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
fn layers_are_read_by_name_and_only_those_wanted_are_made() {
    let text = |output: &str| {
        format!(
            "orogen = 1\n[nodes.a]\nop = \"fbm\"\n[nodes.s]\nop = \"slope\"\nsource = \"a\"\n[outputs]\nheight = \"{output}\"\n"
        )
    };
    let open = |output: &str| World::open(Recipe::parse(&text(output), "t")?);
    let window = Window::new(16, 16, 10.0);
    let world = open("s.south").unwrap();
    let plan = world.plan(&["height"], &window).unwrap();
    let Some(Step::Apply { out, .. }) = plan.steps().iter().find(|step| matches!(step, Step::Apply { .. })) else {
        panic!("a filter is applied")
    };
    assert!(matches!(out.as_slice(), [None, None, Some(_)]), "{}", world.explain(&plan));
    assert!(world.explain(&plan).contains("apply `s` (south)"), "{}", world.explain(&plan));
    // The layer is the rise per metre; together with its neighbour it gives the whole slope.
    let source = world.window("a", &window.grown(1)).unwrap();
    let [east, south] = ["s.east", "s.south"].map(|layer| world.window(layer, &window).unwrap());
    let steep = (source[(5, 6)] - source[(5, 4)]) / 20.0;
    assert!((south[(4, 4)] - steep).abs() < 0.5 * steep.abs() + 1e-4, "{} {steep}", south[(4, 4)]);
    let slope = world.window("s", &window).unwrap()[(4, 4)];
    let whole = libm::atanf(libm::hypotf(east[(4, 4)], south[(4, 4)])).to_degrees();
    assert!((slope - whole).abs() < 1e-3, "{slope} {whole}");
    let error = open("s.sout").err().unwrap().to_string();
    assert!(error.contains("has no layer `sout`; did you mean `south`?"), "{error}");
    let error = open("a.flow").err().unwrap().to_string();
    assert!(error.contains("has no layer `flow`; available: `height`"), "{error}");
    let error = world.window("s.est", &window).unwrap_err().to_string();
    assert!(error.contains("did you mean `east`?"), "{error}");
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
    // Damage anywhere is detected before any number is used; so is a plan of another version.
    let damaged = |from: &str, to: &str| {
        assert!(sent.contains(from), "{from} in {sent}");
        serde_json::from_str::<Plan>(&sent.replacen(from, to, 1)).unwrap_err().to_string()
    };
    for (from, to) in
        [("\"x\":5", "\"x\":6"), ("\"halo\":", "\"halo\":1"), ("\"scattered\":false", "\"scattered\":true")]
    {
        assert!(damaged(from, to).contains("checksum"), "{}", damaged(from, to));
    }
    let version = format!("\"orogen\":\"{}\"", env!("CARGO_PKG_VERSION"));
    assert!(damaged(&version, "\"orogen\":\"0.0.9\"").contains("made by Orogen 0.0.9"));
    // A plan of another recipe, or of this one before it was edited.
    let edited = World::open(Recipe::parse(&text.replace("\"blur\"", "\"blur\"\nradius = 35"), "t").unwrap()).unwrap();
    let error = edited.run(&came, &Progress::none()).unwrap_err();
    assert!(error.kind() == orogen::ErrorKind::Request && error.to_string().contains("another recipe"), "{error}");
}

/// Everything that changes a node's samples changes its content key: stored solutions and cached grids are never stale.
#[test]
fn content_keys_hold_all_that_a_node_reads_of_the_world() {
    let window = Window::new(24, 20, 30.0).at(20, 18);
    let (mut same, mut other) = (0, 0);
    for node in Node::all() {
        let world = world_of(30.0);
        let recipe = recipe_of(&node, world, false);
        let made = |recipe: &Recipe| {
            let world = open(recipe, 1);
            (world.key("node").unwrap(), world.window("node", &window).unwrap())
        };
        let (key, grid) = made(&recipe);
        let size = world.size.unwrap_or_default();
        for changed in [
            WorldSpec { seed: 43, ..world },
            WorldSpec { sea_level: 0.25, ..world },
            WorldSpec { size: Some([size[0] + 300.0, size[1]]), ..world },
            WorldSpec { size: Some([size[0], size[1] + 600.0]), ..world },
            WorldSpec { cell: 60.0, ..world },
        ] {
            let mut recipe = recipe.clone();
            recipe.world = changed;
            let (changed_key, changed_grid) = made(&recipe);
            match key == changed_key {
                true => {
                    same_bits(&format!("{} with {changed:?}", node.spec().op), &grid, &changed_grid);
                    same += 1;
                }
                false => other += 1,
            }
        }
    }
    assert!(same > 100 && other > 100, "{same} {other}");
}

#[test]
fn a_plan_over_memory_is_refused_before_it_starts() {
    let recipe = recipe_of(&Node::named("fbm").unwrap(), WorldSpec::default(), false);
    let options = orogen::Options { threads: Some(1), memory: orogen::Budget::of(64 << 20), ..Default::default() };
    let world = World::with_options(recipe, options).unwrap();
    let error = world.window("height", &Window::new(1 << 20, 1 << 20, 10.0)).unwrap_err();
    assert_eq!(error.kind(), orogen::ErrorKind::Memory);
    assert!(error.to_string().contains("4.0 TiB") && error.to_string().contains("64 MiB"), "{error}");
    assert!(world.window("height", &Window::new(512, 512, 10.0)).is_ok());
}

#[test]
fn windows_and_points_that_are_not_there_are_named() {
    let bounded = open(&recipe_of(&Node::named("fbm").unwrap(), world_of(10.0), false), 1);
    let window = |x, y, width, height, cell| Window { x, y, width, height, cell };
    for (window, said) in [
        (window(-1, 0, 5, 5, 10.0), "not inside the world"),
        (window(0, 70, 5, 12, 10.0), "(0, 0) to (96, 80)"),
        (window(0, 0, 0, 5, 10.0), "is empty"),
        (window(0, 0, 5, 5, 0.0), "not 0"),
        (window(0, 0, 5, 5, f64::NAN), "not NaN"),
        (window(i64::MAX - 3, 0, 5, 5, 10.0), "2^53"),
        (window(0, 0, usize::MAX, 5, 10.0), "2^53"),
    ] {
        let error = bounded.window("height", &window).unwrap_err();
        assert!(error.to_string().contains(said), "{window:?}: {error}");
    }
    assert!(
        bounded.window("hight", &Window::new(2, 2, 10.0)).unwrap_err().to_string().contains("did you mean `height`?")
    );
    for (x, y, said) in [(f64::NAN, 0.0, "finite"), (-1.0, 0.0, "outside the world"), (0.0, 801.0, "(960, 800)")] {
        let error = bounded.height(x, y).unwrap_err();
        assert!(error.to_string().contains(said), "{error}");
    }
    assert!(bounded.height(960.0, 800.0).is_ok(), "the far corner is part of the world");
}

#[test]
fn cancelled_work_stops() {
    let world = open(&recipe_of(&Node::named("blur").unwrap(), world_of(10.0), false), 2);
    let progress = Progress::none();
    progress.cancel();
    let error = world.grids(&["height"], &Window::new(90, 70, 10.0), &progress).unwrap_err();
    assert_eq!(error.kind(), orogen::ErrorKind::Cancelled);
}

#[test]
fn one_world_serves_many_threads_at_once() {
    use rayon::prelude::*;
    // Requests from the threads of a pool, each waiting for solvers that need threads too.
    let world = open(&recipe_of(&Node::named("bake").unwrap(), world_of(10.0), false), 2);
    let window = Window::new(40, 40, 10.0).at(7, 9);
    let expect = world.window("height", &window).unwrap();
    let fresh = open(&recipe_of(&Node::named("bake").unwrap(), world_of(10.0), false), 2);
    let all: Vec<Grid> = (0..32).into_par_iter().map(|_| fresh.window("height", &window).unwrap()).collect();
    assert!(all.iter().all(|grid| *grid == expect));
}
