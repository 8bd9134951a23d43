//! Invariants of all nodes. New nodes are included automatically.

use crate::support::{laws_of, open, recipe_of, world_of};
use orogen::declare::{Shape, Stratum};
use orogen::field::{Add, Constant, Fbm, Outcrop, Perlin, Warp};
use orogen::filter::{LocalStreamPower, Thermal};
use orogen::ids::Id;
use orogen::laws::{CELLS, Violation};
use orogen::node::Node;
use orogen::op::Op;
use orogen::plan::Plan;
use orogen::plan::steps::Step;
use orogen::solver::{Normalise, StreamPower};
use orogen::value::Value;
use orogen::{Grid, Progress, Recipe, Window, World, WorldSpec};

fn holds<T>(verdict: Result<T, Violation>) -> T {
    verdict.unwrap_or_else(|violation| panic!("{violation}"))
}

#[test]
fn tile_equals_crop_for_every_node() {
    for cell in CELLS {
        for node in Node::all() {
            for masked in [false, true] {
                holds(laws_of(&node).tiles(cell, masked));
            }
        }
    }
}

#[test]
fn large_windows_of_levelled_ops_agree() {
    for node in Node::all() {
        holds(laws_of(&node).pieces());
    }
}

#[test]
fn every_node_has_the_same_bits_at_every_level() {
    for node in Node::all() {
        holds(laws_of(&node).levels());
    }
}

#[test]
fn every_node_is_the_same_from_disk_and_in_tiles_of_any_size() {
    for node in Node::all() {
        holds(laws_of(&node).stored(1.0 / 3.0));
    }
}

#[test]
fn every_node_can_be_warped_and_turned() {
    for node in Node::all() {
        holds(laws_of(&node).warped(30.0));
    }
}

#[test]
fn unbounded_worlds_agree_far_out_and_below_zero() {
    for node in Node::all() {
        holds(laws_of(&node).unbounded());
    }
}

#[test]
fn every_solver_obeys_the_laws_with_a_margin() {
    let solvers = Node::all().into_iter().filter(|node| node.margin().is_some());
    let checked = solvers.map(|node| holds(laws_of(&node).margin(10.24))).count();
    assert_eq!(checked, 18);
}

#[test]
fn ops_in_strata_obey_the_laws() {
    let strata = || {
        let strata = [(7.0, 0.2, 70.0), (20.0, 3.0, 30.0)];
        let stratum =
            |(thickness, erodibility_factor, talus_angle)| Stratum { thickness, erodibility_factor, talus_angle };
        strata.map(stratum).to_vec()
    };
    let nodes: [Node; 4] = [
        Outcrop { strata: strata(), repeat_strata: true, ..Outcrop::default() }.into(),
        Thermal { strata: strata(), repeat_strata: true, iterations: 9, ..Thermal::default() }.into(),
        LocalStreamPower { strata: strata(), repeat_strata: true, iterations: 9, ..LocalStreamPower::default() }.into(),
        StreamPower { strata: strata(), repeat_strata: true, steps: 3, ..StreamPower::default() }.into(),
    ];
    for node in nodes {
        for cell in CELLS {
            holds(laws_of(&node).tiles(cell, true));
        }
        holds(laws_of(&node).levels());
        holds(laws_of(&node).stored(1.0 / 3.0));
    }
}

#[test]
fn fields_agree_where_two_resolutions_share_samples() {
    for node in Node::all() {
        for cell in [8.0, 10.24, 0.1, 1.0 / 3.0] {
            holds(laws_of(&node).resolutions(cell));
        }
    }
}

#[test]
fn every_field_obeys_the_laws_in_space() {
    for node in Node::all() {
        holds(laws_of(&node).altitudes(10.24));
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
    // On a thread with a small stack, to prove that there is no recursion along the chain.
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
    recipe.add("land", Normalise { source: "noise".into(), low: -250.0, high: 1234.0, ..Normalise::default() });
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
                .filter(|i| matches!(i, orogen::plan::program::Instruction::Field { node, .. } if node.index() == 0))
                .count(),
            Step::Apply { .. } | Step::Refine { .. } => 0,
        })
        .sum();
    assert_eq!(fields, 1, "{}", world.explain(&plan).unwrap());
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
    assert!(matches!(out.as_slice(), [None, None, Some(_)]), "{}", world.explain(&plan).unwrap());
    assert!(world.explain(&plan).unwrap().contains("apply `s` (south)"), "{}", world.explain(&plan).unwrap());
    // The layer is the rise per metre; with the other slope layer it gives the whole slope.
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
    // Damage anywhere is detected before any number is used; a plan of another version is rejected as well.
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
    // A plan from before the format had a number.
    assert!(damaged("\"format\":4,", "").contains("has format 1, this version reads format 4"));
    // A plan of another recipe, or of this recipe before it was edited.
    let edited = World::open(Recipe::parse(&text.replace("\"blur\"", "\"blur\"\nradius = 35"), "t").unwrap()).unwrap();
    // A recipe without nodes: a plan's nodes are not nodes of another recipe.
    let bare = Recipe::parse("orogen = 1\n[world]\ncell = 10\n[outputs]\nheight = 5", "t").unwrap();
    for other in [edited, World::open(bare).unwrap()] {
        let refusals = [
            other.run(&came, &Progress::none()).map(|_| ()),
            other.memory_of(&came).map(|_| ()),
            other.work(&came).map(|_| ()),
            other.explain(&came).map(|_| ()),
        ];
        for error in refusals.map(Result::unwrap_err) {
            assert!(
                error.kind() == orogen::ErrorKind::Request && error.to_string().contains("another recipe"),
                "{error}"
            );
        }
    }
}

/// Everything that changes a node's samples changes its content key, so stored solutions and cached grids are never
/// stale.
#[test]
fn content_keys_hold_all_that_a_node_reads_of_the_world() {
    let nodes = Node::all();
    let same: usize = nodes.iter().map(|node| holds(laws_of(node).content_keys())).sum();
    let other = 5 * nodes.len() - same;
    assert!(same > 100 && other > 100, "{same} {other}");
}

#[test]
fn a_plan_over_memory_is_refused_before_it_starts() {
    let recipe = recipe_of(&Node::named("fbm").unwrap(), WorldSpec::default(), false);
    let options = orogen::Options { threads: Some(1), memory: orogen::Budget::of(64 << 20), ..Default::default() };
    let world = World::with_options(recipe, options).unwrap();
    let error = world.window("height", &Window::new(1 << 20, 1 << 20, 10.0)).unwrap_err();
    assert_eq!(error.kind(), orogen::ErrorKind::Memory);
    assert!(error.to_string().contains("4.1 TiB") && error.to_string().contains("64 MiB"), "{error}");
    assert!(world.window("height", &Window::new(512, 512, 10.0)).is_ok());
}

/// With parameters at the ends of their ranges, over windows of all sizes.
#[test]
fn no_estimate_of_memory_overflows() {
    for node in Node::all() {
        for end in [0, 1] {
            let mut node = node.clone();
            for (i, spec) in node.spec().params.iter().enumerate() {
                let value = match spec.shape {
                    Shape::Number => Value::Number(spec.range[end]),
                    Shape::Integer => Value::Integer(spec.range[end] as i64),
                    _ => continue,
                };
                node.set_param(i, &value).unwrap();
            }
            let mut before = 0;
            for side in [1, 100, 1 << 20, 1 << 31, 1 << 53] {
                let window = Window::new(side, side, 10.0);
                let memory = match node.op() {
                    Op::Filter(filter) => filter.scratch(&window),
                    Op::Solver(solver) => solver.scratch(&window),
                    Op::Field(_) | Op::Levelled(_) => 0,
                };
                assert!(memory >= before, "{} at {side} x {side}: {memory} after {before}", node.spec().op);
                before = memory;
            }
        }
    }
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
        (window(0, 0, usize::MAX, 5, 10.0), "2147483648 along a side"),
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
    // Requests from the threads of a pool; each waits for solvers that also need threads.
    let world = open(&recipe_of(&Node::named("bake").unwrap(), world_of(10.0), false), 2);
    let window = Window::new(40, 40, 10.0).at(7, 9);
    let expect = world.window("height", &window).unwrap();
    let fresh = open(&recipe_of(&Node::named("bake").unwrap(), world_of(10.0), false), 2);
    let all: Vec<Grid> = orogen::grid::parallel::map(0..32, |_| fresh.window("height", &window).unwrap());
    assert!(all.iter().all(|grid| *grid == expect));
}
