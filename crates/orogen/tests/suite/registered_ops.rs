//! Ops that a program declares and registers in addition to the built-in ones.

mod lawless;
mod ops;
mod refused;

use ops::{Above, Crests, Midpoints, Ripples, Wave, other, registry};
use orogen::io::test_folder::TestFolder;
use orogen::laws::Laws;
use orogen::node::Node;
use orogen::plan::Plan;
use orogen::recipe::{reference, schema};
use orogen::{Error, ErrorKind, Options, Progress, Recipe, Registry, Session, Window, World, WorldSpec};
use std::path::Path;

const RECIPE: &str = r#"
    orogen = 1
    [parameters]
    length = 300
    [world]
    seed = 5
    size = [2400, 1800]
    cell = 10.0
    [nodes.noise]
    op = "fbm"
    wavelength = 700
    [nodes.hills]
    op = "normalise"
    source = "noise"
    high = 200
    [nodes.rippled]
    op = "mygame.ripples"
    source = "hills"
    spacing = "= length / 3"
    wave = "square"
    [nodes.east]
    op = "mygame.ripples"
    seed = 9
    [nodes.moved]
    op = "warp"
    source = "rippled"
    x = "east"
    y = "noise"
    strength = 40
    [nodes.above]
    op = "mygame.above"
    source = "moved"
    [nodes.crests]
    op = "mygame.crests"
    source = "above"
    mask = "above.side"
    [nodes.low]
    op = "min"
    a = "crests"
    b = "crests.crest"
    [outputs]
    height = "crests"
    side = "above.side"
    low = "low"
"#;

fn window() -> Window {
    Window::new(120, 90, 10.0).at(60, 50)
}

#[test]
fn they_obey_the_laws() {
    let violations = [
        Laws::of(|cell| Ripples { wavelength: 7.3 * cell, seed: 3, ..Ripples::default() }).check(),
        Laws::of(|cell| Ripples { wavelength: 7.3 * cell, wave: Wave::Square, ..Ripples::default() }).check(),
        Laws::of(|cell| Crests { reach: 2.5 * cell, ..Crests::default() }).check(),
        Laws::of(|cell| Midpoints { cell, ..Midpoints::default() }).check(),
        // At finer and coarser cells, and between the levels.
        Laws::of(|cell| Midpoints { cell: 2.7 * cell, seed: 5, levels: 9, ..Midpoints::default() }).check(),
        Laws::of(|cell| Midpoints { cell: 0.31 * cell, levels: 2, ..Midpoints::default() }).check(),
        Laws::of(|_| Above::default()).check(),
    ]
    .concat();
    assert!(violations.is_empty(), "{violations:#?}");
}

#[test]
fn they_stand_beside_built_in_ops_warped_masked_and_by_layers() {
    let world = World::open(registry().parse(RECIPE, "r").unwrap()).unwrap();
    let layers = ["height", "side", "low", "above", "moved"];
    let window = window();
    let grids = world.grids(&layers, &window, &Progress::none()).unwrap();
    let [height, side, low, above, moved] = grids.as_slice() else { panic!("five layers") };
    let around = world.window("above", &window.grown(3)).unwrap();
    // The moved ripples, computed by hand from noise and ripples; half a wavelength is 50 m.
    let plain = world.window("hills", &window).unwrap();
    assert!(moved.data().iter().zip(plain.data()).any(|(a, b)| (a - b).abs() > 5.0), "the warp moves");
    let (mut inside, mut outside) = (0, 0);
    for (i, j) in (0..window.height).flat_map(|j| (0..window.width).map(move |i| (i, j))) {
        let crest = (0..49).map(|k| around[(i + k % 7, j + k / 7)]).fold(f32::MIN, f32::max);
        // The mask blends the first input and the result.
        let expect = if side[(i, j)] == 1.0 { crest } else { above[(i, j)] };
        assert!((height[(i, j)] - expect).abs() < 1e-4, "{} {expect} at ({i}, {j})", height[(i, j)]);
        assert_eq!(side[(i, j)] == 1.0, above[(i, j)] > 0.0);
        assert!(low[(i, j)] <= 1.0);
        *if side[(i, j)] == 1.0 { &mut inside } else { &mut outside } += 1;
    }
    assert!(inside > 500 && outside > 500, "{inside} {outside}");
    // Ripples at a point, computed by hand.
    let ripples = world.points("rippled", &[1003.0], &[704.0]).unwrap()[0]
        - world.points("hills", &[1003.0], &[704.0]).unwrap()[0];
    let turns = 1003.0 / 100.0 + (world.recipe().world.world_params().seed_of(0) % 1000) as f64 / 1000.0;
    let expect = if turns.fract() < 0.5 { 0.0 } else { 1.0 };
    assert!((ripples - expect).abs() < 1e-4, "{ripples} {expect}");
}

#[test]
fn plans_explain_them_and_can_be_sent() {
    let world = World::open(registry().parse(RECIPE, "r").unwrap()).unwrap();
    let plan = world.plan(&["height"], &window()).unwrap();
    let explained = world.explain(&plan).unwrap();
    for said in
        ["mygame.ripples", "mygame.crests", "halo of 3 samples", "solve `above`", "apply `crests`", "What lies above"]
    {
        assert!(explained.contains(said), "{said} is not in\n{explained}");
    }
    // Two rasters and three grids of the padded world count.
    let padded = plan.solves()[1].padded.len() as u64;
    assert!(world.memory_of(&plan).unwrap() > 5 * 4 * padded, "{explained}");
    let sent: Plan = serde_json::from_str(&serde_json::to_string(&plan).unwrap()).unwrap();
    assert_eq!(world.run(&sent, &Progress::none()).unwrap()[0], world.window("height", &window()).unwrap());
    // Another revision of one op gives another recipe key.
    let mut edited = registry().parse(RECIPE, "r").unwrap();
    edited.change(|node| {
        if node.spec().op == "mygame.above" {
            let input = node.input(0).clone();
            *node = other::Above { source: input }.into();
        }
    });
    let error = World::open(edited).unwrap().run(&sent, &Progress::none()).unwrap_err();
    assert!(error.to_string().contains("another recipe"), "{error}");
}

#[test]
fn recipes_of_them_are_written_and_read_again() {
    let registry = registry();
    let recipe = registry.parse(RECIPE, "r").unwrap();
    let written = recipe.to_toml();
    assert!(written.contains("op = \"mygame.ripples\"") && written.contains("wave = \"square\""), "{written}");
    assert!(written.contains("wavelength = \"= length / 3\""), "the formula of a former key is kept:\n{written}");
    let again = registry.parse(&written, "again").unwrap_or_else(|error| panic!("{error}\n{written}"));
    assert_eq!(recipe, again);
    assert_eq!(recipe, recipe.clone());
    let with = registry.parse_with(&written, "again", &[("length".to_string(), 600.0)]).unwrap();
    assert_ne!(recipe, with, "parameters of registered ops count");
    assert!(format!("{recipe:?}").contains("Ripples"));
    let toml = "orogen = 1\n[nodes.a]\nop = \"mygame.ripples\"\nwave = \"square\"\n[outputs]\nheight = \"a\"\n";
    let json = r#"{ "orogen": 1, "nodes": { "a": { "op": "mygame.ripples", "wave": "square" } }, "outputs": { "height": "a" } }"#;
    assert_eq!(registry.parse(toml, "t").unwrap(), registry.parse(json, "j").unwrap());
    // In code, no registry is needed.
    let mut code = Recipe::new(WorldSpec::default());
    code.add("a", Ripples { wave: Wave::Square, ..Ripples::default() }).output("height", "a");
    assert_eq!(code, registry.parse(toml, "t").unwrap());
    let Node::Registered(op) = &code.nodes()[0].node else { panic!("not a built-in op") };
    assert!(op.get::<Ripples>().is_some_and(|op| op.wave == Wave::Square) && op.get::<Crests>().is_none());
    assert!(matches!(Node::from(orogen::field::Fbm::default()), Node::Fbm(_)), "a built-in op stays one");
}

#[test]
fn used_recipes_may_have_them() {
    let folder = TestFolder::new("registered").unwrap();
    let part = "orogen = 1\n[nodes.low]\nop = \"input\"\n[nodes.r]\nop = \"mygame.ripples\"\nsource = \"low\"\n[outputs]\nheight = \"r\"\n";
    std::fs::write(folder.join("part.toml"), part).unwrap();
    let whole = "orogen = 1\n[nodes.n]\nop = \"fbm\"\n[use.part]\nrecipe = \"part.toml\"\nseed = 4\n[use.part.inputs]\nlow = \"n\"\n\
                 [outputs]\nheight = \"part\"\n";
    std::fs::write(folder.join("whole.toml"), whole).unwrap();
    let read = |registry: &Registry| registry.read(&folder.join("whole.toml"));
    let recipe = read(&registry()).unwrap();
    let by_hand = |seed| {
        let mut recipe = Recipe::new(WorldSpec::default());
        recipe.add("n", orogen::field::Fbm::default());
        recipe.add("r", Ripples { source: "n".into(), seed, ..Ripples::default() }).output("height", "r");
        World::open(recipe).unwrap().window("height", &window()).unwrap()
    };
    let made = World::open(recipe).unwrap().window("height", &window()).unwrap();
    assert_ne!(made, by_hand(0), "the seed of the use is hashed with the node's");
    let error = read(&Registry::new()).unwrap_err().to_string();
    assert!(error.contains("part.toml:5:6") && error.contains("namespace `mygame`"), "{error}");
}

#[test]
fn schema_and_reference_tell_of_them() {
    let registry = registry();
    let schema = schema::json_schema_of(&registry);
    let node = &schema["definitions"]["node"];
    let ops = node["properties"]["op"]["enum"].as_array().unwrap();
    assert!(ops.iter().any(|op| op == "mygame.crests") && ops.iter().any(|op| op == "fbm"));
    let cases = node["allOf"].as_array().unwrap();
    let case = cases.iter().find(|case| case["then"]["title"] == "mygame.ripples").unwrap();
    let keys = &case["then"]["properties"];
    assert_eq!(keys["wavelength"]["default"], 100.0);
    assert_eq!(keys["wave"]["oneOf"][1]["const"], "square");
    assert_eq!(keys["spacing"]["deprecated"], true);
    assert!(schema::json_schema().to_string().len() < schema.to_string().len());
    assert!(!schema::json_schema().to_string().contains("mygame"));
    let page = reference::markdown_of(&registry);
    assert!(
        page.contains("### `mygame.crests`") && page.contains("| `crest` | 1 on a crest, 0 elsewhere. |"),
        "{page}"
    );
    assert!(!reference::markdown().contains("mygame"));
    assert!(reference::overview_of(&registry).contains("mygame.above"));
    let help = reference::describe(&registry.named("mygame.ripples").unwrap());
    for said in
        ["mygame.ripples (field)", "a finite number from 0.001 to 1e9 (m); default 100.0", "\"square\": Upright sides."]
    {
        assert!(help.contains(said), "{said} is not in\n{help}");
    }
}

#[test]
fn faults_are_told_where_they_are() {
    let registry = registry();
    let error = |line: &str| {
        let text = format!("orogen = 1\n[nodes.n]\n{line}\n[outputs]\nheight = \"n\"\n");
        registry.parse(&text, "r.toml").map(|_| ()).unwrap_err().to_string()
    };
    for (line, said) in [
        ("op = \"mygame.riples\"", "unknown op `mygame.riples`; did you mean `mygame.ripples`?"),
        (
            "op = \"mygame.xylophone\"",
            "available: `mygame.ripples`, `mygame.crests`, `mygame.midpoints` and `mygame.above`",
        ),
        ("op = \"mygme.ripples\"", "no op of the namespace `mygme` is registered; did you mean `mygame.ripples`?"),
        ("op = \"elsewhere.hexagons\"", "no op of the namespace `elsewhere` is registered. Ops with a namespace"),
        ("op = \"ripples\"", "unknown op `ripples`; did you mean `mygame.ripples`?"),
        ("op = \"fbmm\"", "did you mean `fbm`?"),
        ("op = \"mygame.ripples\"\nwave = \"sqare\"", "did you mean \"square\"?"),
        ("op = \"mygame.ripples\"\nwavelength = -1", "`wavelength` must be a finite number from 0.001 to 1e9 (m)"),
        ("op = \"mygame.ripples\"\nspacng = 1", "unknown key `spacng` in node `n` (op `mygame.ripples`)"),
        ("op = \"mygame.crests\"\nsource = 1\nwithin = [2, 1]", "must be the lower bound"),
        ("op = \"mygame.crests\"", "node `n`, `source`: it is missing"),
        ("op = \"mygame.above\"\nsource = 1", "the op `mygame.above` looks at the whole world"),
    ] {
        assert!(error(line).contains(said), "{said} is not in: {}", error(line));
        assert!(error(line).contains("r.toml:"), "{}", error(line));
    }
}

#[test]
fn bad_and_double_names_are_refused() {
    fn refuses<T: orogen::op::OpType>(registry: &Registry) -> String {
        let mut registry = registry.clone();
        let before = registry.registered().len();
        let error: Error = registry.register::<T>().map(|_| ()).unwrap_err();
        assert_eq!((error.kind(), registry.registered().len()), (ErrorKind::Request, before));
        error.to_string()
    }
    let mut registry = registry();
    registry.register::<refused::Grey>().unwrap();
    for (error, said) in [
        (refuses::<refused::Bare>(&registry), "the op `terraces` has no namespace"),
        (refuses::<refused::BuiltIn>(&registry), "`mygame.fbm`"),
        (refuses::<refused::Capital>(&registry), "`MyGame.terraces` cannot be an op's name"),
        (refuses::<refused::Deep>(&registry), "a namespace, a dot and a name"),
        (refuses::<refused::Double>(&registry), "`mygame.ripples` is registered already"),
        (refuses::<refused::Gray>(&registry), "another spelling of the op `mygame.grey`"),
        (refuses::<refused::Masked>(&registry), "a key `mask`"),
        (refuses::<refused::Outside>(&registry), "defaults: `value` must be a finite number from 0 to 10"),
        (refuses::<orogen::field::Fbm>(&registry), "a built-in op"),
    ] {
        assert!(error.contains(said), "{said} is not in: {error}");
    }
    // In code, without checks by a registry.
    let open = |nodes: [Node; 2]| {
        let mut recipe = Recipe::new(WorldSpec::default());
        for (i, node) in nodes.into_iter().enumerate() {
            recipe.add(&format!("n{i}"), node);
        }
        recipe.output("height", "n0");
        World::open(recipe).map(|_| ()).map_err(|error| error.to_string())
    };
    assert!(
        open([Node::from(refused::BuiltIn::default()), Ripples::default().into()])
            .unwrap_err()
            .contains("no namespace")
    );
    let error = open([Node::from(refused::Double::default()), Ripples::default().into()]).unwrap_err();
    assert!(error.contains("two different ops are named `mygame.ripples`"), "{error}");
    assert_eq!(open([Ripples { seed: 1, ..Ripples::default() }.into(), Ripples::default().into()]), Ok(()));
}

#[test]
fn a_session_keeps_their_solutions_and_tells_revisions_apart() {
    let session = Session::new(Options { threads: Some(2), ..Options::default() }).unwrap();
    let text = "orogen = 1\n[world]\nsize = 1000\ncell = 10\n[nodes.n]\nop = \"fbm\"\n[nodes.above]\nop = \"mygame.above\"\nsource = \"n\"\n\
                [outputs]\nheight = \"above\"\n";
    let window = Window::new(50, 40, 10.0).at(3, 5);
    let made = |registry: &Registry, text: &str| {
        let before = session.solutions_made();
        let grid = session.open(registry.parse(text, "r").unwrap()).unwrap().window("height", &window).unwrap();
        (grid, session.solutions_made() - before)
    };
    let (first, solved) = made(&registry(), text);
    assert_eq!(solved, 1);
    assert_eq!(made(&registry(), text), (first.clone(), 0), "found again, by another registry of the same op");
    let mut newer = Registry::new();
    newer.register::<other::Above>().unwrap();
    let (twice, solved) = made(&newer, text);
    assert_eq!(solved, 1, "another revision is another solution");
    assert!(twice != first && twice.data().iter().zip(first.data()).all(|(twice, once)| *twice == 2.0 * once));
    assert_eq!(made(&registry(), text), (first, 0), "both are kept");
    assert_eq!(made(&registry(), &text.replace("\"fbm\"", "\"fbm\"\nseed = 2")).1, 1, "its source's key counts");
}

#[test]
fn the_page_shows_the_code_of_the_example() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let read = |file: &str| std::fs::read_to_string(folder.join(file)).unwrap();
    let (example, page) = (read("examples/op_of_your_own.rs"), read("../../docs/ops-of-your-own.md"));
    let blocks: Vec<&str> = page.split("```rust\n").skip(1).filter_map(|block| block.split("\n```").next()).collect();
    assert_eq!(blocks.len(), 5);
    for block in blocks {
        assert!(example.contains(block), "the example does not have:\n{block}");
    }
}
