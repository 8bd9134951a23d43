//! Random graphs: for any valid recipe, the bits of a window do not depend on how it is made.

mod grown;
mod values;

use crate::support::Random;
use grown::{Grown, Tally, grown};
use orogen::io::test_folder::TestFolder;
use orogen::laws::at_level;
use orogen::node::Node;
use orogen::tiles::Tiling;
use orogen::{
    Budget, Error, ErrorKind, FolderStore, Grid, Level, Options, Progress, Recipe, Result, Session, SolutionStore,
    Window, World,
};
use std::collections::BTreeSet;
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::time::Duration;

#[test]
fn three_random_graphs_keep_their_bits() {
    check(0..3);
}

/// `OROGEN_GRAPHS=17..18` runs only graph 17.
#[test]
#[ignore = "long: a thousand random graphs, each made in thirty ways"]
fn a_thousand_random_graphs_keep_their_bits() {
    let chosen = std::env::var("OROGEN_GRAPHS").ok();
    let range = chosen.as_deref().map_or(0..1000, |text| {
        let (first, end) = text.split_once("..").expect("OROGEN_GRAPHS is a range such as 17..18");
        first.parse().unwrap()..end.parse().unwrap()
    });
    check(range);
}

fn check(seeds: Range<u64>) {
    let mut tally = Tally::default();
    let (mut broken, mut ops) = (Vec::new(), BTreeSet::new());
    let is_whole = seeds.end - seeds.start >= 1000;
    for seed in seeds {
        let mut text = String::new();
        let keeps = || {
            let graph = grown(seed, &mut tally, &mut |recipe| text = recipe.to_toml());
            text = graph.recipe.to_toml();
            let own: Vec<&str> = graph.recipe.nodes().iter().map(|named| named.node.spec().op).collect();
            println!("graph {seed}: {} samples of {}", graph.window.len(), own.join(", "));
            ops.extend(own);
            keeps_its_bits(&graph, seed, &mut tally);
        };
        if catch_unwind(AssertUnwindSafe(keeps)).is_err() {
            eprintln!("graph {seed} is broken:\n{text}");
            broken.push(seed);
        }
    }
    println!("{tally:?}");
    assert!(broken.is_empty(), "graphs {broken:?}");
    // At most a third of the drawn nodes is left out, and no op is always left out.
    let left_out = tally.refused + tally.expensive;
    assert!(3 * left_out < tally.nodes + left_out + 100, "{tally:?}");
    assert!(!is_whole || ops.len() == Node::all().len(), "{ops:?}");
}

/// Makes all outputs.
fn made(world: &World, window: &Window) -> Result<Vec<Grid>> {
    let layers: Vec<&str> = world.recipe().outputs().collect();
    world.grids(&layers, window, &Progress::none())
}

/// Checks that parts have the bits of the whole.
fn same(what: &str, whole: &[Grid], parts: &[Grid]) {
    assert_eq!(whole.len(), parts.len(), "{what}");
    for (layer, (whole, part)) in whole.iter().zip(parts).enumerate() {
        let crop = whole.crop(part.window()).unwrap();
        let differs = |(a, b): (&f32, &f32)| a.to_bits() != b.to_bits() && !(a.is_nan() && b.is_nan());
        if let Some(k) = crop.data().iter().zip(part.data()).position(differs) {
            let (i, j) = (k % part.width(), k / part.width());
            let window = part.window();
            panic!(
                "{what}, output {layer}, sample ({i}, {j}) of {window:?}: {:?}, not {:?}",
                part[(i, j)],
                crop[(i, j)]
            );
        }
    }
}

fn keeps_its_bits(graph: &Grown, seed: u64, tally: &mut Tally) {
    let (Grown { recipe, window }, mut random) = (graph, Random(!seed));
    let open = |options: Options| World::with_options(recipe.clone(), options).unwrap();
    let with_threads = |threads| open(Options { threads: Some(threads), ..Options::default() });
    let world = with_threads(1);
    let whole = made(&world, window).unwrap();
    let same = |what: &str, made: Result<Vec<Grid>>| {
        let made = made.unwrap_or_else(|error| panic!("{what}: {error}"));
        same(what, &whole, &made);
    };
    same("again", made(&world, window));
    for threads in [2, 7] {
        same(&format!("{threads} threads"), made(&with_threads(threads), window));
    }
    for level in Level::available() {
        let made = at_level(level, || made(&with_threads(2), window));
        same(&format!("{level:?}"), made.unwrap());
    }
    for (k, layer) in recipe.outputs().enumerate() {
        let alone = with_threads(2).window(layer, window).unwrap();
        self::same("alone", &whole[k..=k], &[alone]);
    }
    // Windows of the whole, made by a new world and by one that has made other windows.
    for k in 0..4 {
        let part = part(window, &mut random);
        let world = if k < 2 { &with_threads(2) } else { &world };
        same("a part", made(world, &part));
    }
    let layers: Vec<&str> = recipe.outputs().collect();
    let tiling = Tiling { overlap: random.below(2) as usize, ..Tiling::of(*random.of(&[5, 16, 33])) };
    for tile in world.tiles(&layers, window, tiling, &Progress::none()).unwrap() {
        same("a tile", tile.map(|tile| tile.grids));
    }
    if window.cell == recipe.world.cell {
        let [i, j] = [window.width, window.height].map(|side| random.below(side as u64) as usize);
        for (layer, whole) in layers.iter().zip(&whole) {
            let point = world.points(layer, &[window.east(i)], &[window.south(j)]).unwrap()[0];
            let sample = whole[(i, j)];
            let is_same = point.to_bits() == sample.to_bits() || point.is_nan() && sample.is_nan();
            assert!(is_same, "the point ({i}, {j}) of {layer}: {point:?}, not {sample:?}");
        }
    }
    texts(recipe, window, &same);
    let folder = TestFolder::new("graphs").unwrap();
    for what in ["a cold cache", "a warm cache"] {
        let store = FolderStore { slower_than: Duration::ZERO, ..FolderStore::new(&*folder) };
        let store = Some(Arc::new(store) as Arc<dyn SolutionStore>);
        same(what, made(&open(Options { threads: Some(2), store, ..Options::default() }), window));
    }
    limits(recipe, window, &same, tally);
}

/// A window within another one.
fn part(whole: &Window, random: &mut Random) -> Window {
    let mut within = |side: usize| {
        let part = 1 + random.below(side as u64) as usize;
        (random.below((side - part + 1) as u64) as i64, part)
    };
    let ((x, width), (y, height)) = (within(whole.width), within(whole.height));
    Window::new(width, height, whole.cell).at(whole.x + x, whole.y + y)
}

/// A recipe that is written and read again, as TOML and as JSON, is the same, and so is a plan.
fn texts(recipe: &Recipe, window: &Window, same: &dyn Fn(&str, Result<Vec<Grid>>)) {
    let toml = recipe.to_toml();
    let from_toml = Recipe::parse(&toml, "graph").unwrap();
    assert_eq!(from_toml.to_toml(), toml);
    let from_json: Recipe = serde_json::from_str(&serde_json::to_string(recipe).unwrap()).unwrap();
    for (what, read) in [("TOML", from_toml), ("JSON", from_json)] {
        assert!(read == *recipe, "{what}: {}", read.to_toml());
        same(what, made(&World::open(read).unwrap(), window));
    }
    let world = World::open(recipe.clone()).unwrap();
    let layers: Vec<&str> = recipe.outputs().collect();
    let mut plan = world.plan(&layers, window).unwrap();
    let read = serde_json::from_str(&serde_json::to_string(&plan).unwrap()).unwrap();
    same("a plan from JSON", world.run(&read, &Progress::none()));
    plan.solve_on_disk(37);
    same("solutions on disk", World::open(recipe.clone()).unwrap().run(&plan, &Progress::none()));
}

/// Under a memory limit a window has the same bits, or is refused before the work starts. The memory that a refusal
/// names is enough.
fn limits(recipe: &Recipe, window: &Window, same: &dyn Fn(&str, Result<Vec<Grid>>), tally: &mut Tally) {
    let limited = |bytes: u64| {
        let options = Options { threads: Some(2), memory: Budget::of(bytes), ..Options::default() };
        let session = Session::new(options).unwrap();
        let made = session.open(recipe.clone()).and_then(|world| made(&world, window));
        assert!(session.budget().peak() <= bytes, "{} bytes of {bytes}", session.budget().peak());
        made
    };
    let world = World::with_options(recipe.clone(), Options { threads: Some(2), ..Options::default() }).unwrap();
    let layers: Vec<&str> = recipe.outputs().collect();
    let needed = world.memory_of(&world.plan(&layers, window).unwrap()).unwrap();
    same("the memory that the plan states", limited(needed));
    for bytes in [0, needed / 100, needed / 10, needed / 2, needed - 1] {
        tally.limited[0] += 1;
        match limited(bytes) {
            Err(error) if is_for_memory(&error) => tally.limited[1] += 1,
            made => same(&format!("{bytes} bytes"), made),
        }
    }
}

/// Whether an error is about memory. Files are also refused under a memory limit.
fn is_for_memory(error: &Error) -> bool {
    error.kind() == ErrorKind::Memory || error.kind() == ErrorKind::File && error.to_string().contains("memory")
}
