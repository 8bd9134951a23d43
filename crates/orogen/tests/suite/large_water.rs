//! Filling and drainage on disk, tile by tile, are bit-identical to filling and drainage in memory.

use orogen::{Budget, Options, Progress, Recipe, Window, World};

const LAYERS: [&str; 7] = ["flow", "receiver", "watershed", "strahler", "filled", "full", "depth"];

/// Rough ground with plateaus and level basins, some as wide as several tiles.
fn recipe(width: usize, height: usize, over: &str) -> Recipe {
    let text = format!(
        r#"
orogen = 1
[world]
seed = 11
size = [{}, {}]
cell = 30.0
sea_level = 0.0
[nodes.land]
op = "fbm"
wavelength = 60000
octaves = 9
[nodes.metres]
op = "remap"
source = "land"
to = [-400, 2600]
[nodes.level]
op = "clamp"
source = "metres"
low = 700
high = 1400
[nodes.drained]
op = "drainage"
source = "level"
over = "{over}"
[nodes.full]
op = "fill"
source = "level"
[outputs]
flow = "drained.flow"
receiver = "drained.receiver"
watershed = "drained.watershed"
strahler = "drained.strahler"
filled = "drained.filled"
full = "full"
depth = "full.depth"
"#,
        width as f64 * 30.0,
        height as f64 * 30.0
    );
    Recipe::parse(&text, "water.toml").unwrap()
}

fn open(recipe: &Recipe, memory: Option<u64>) -> World {
    World::with_options(recipe.clone(), Options { memory: Budget::of(memory), ..Options::default() }).unwrap()
}

/// Compares all layers window by window. A small `memory` moves them to disk; without a limit the plan forces them
/// there.
fn compare(width: usize, height: usize, over: &str, memory: Option<u64>) {
    let recipe = recipe(width, height, over);
    let (whole, tiled) = (open(&recipe, None), open(&recipe, memory));
    let mut level = 0u64;
    for window in Window::new(width, height, 30.0).tiles(400) {
        let mut plan = tiled.plan(&LAYERS, &window).unwrap();
        if memory.is_none() {
            plan.solve_on_disk(1024);
        }
        assert!(plan.solves().iter().all(|solve| solve.on_disk), "{}", tiled.explain(&plan).unwrap());
        let progress = Progress::none();
        let expect = whole.grids(&LAYERS, &window, &progress).unwrap();
        let got = tiled.run(&plan, &progress).unwrap();
        for ((name, expect), got) in LAYERS.iter().zip(&expect).zip(&got) {
            let differ = expect.data().iter().zip(got.data()).position(|(a, b)| a.to_bits() != b.to_bits());
            assert_eq!(differ, None, "{name} over the {over}, {window:?}");
        }
        level += expect[4].data().windows(2).filter(|pair| pair[0] == pair[1]).count() as u64;
    }
    assert!(level * 3 > (width * height) as u64, "this is about flats: {level}");
}

#[test]
fn drainage_on_disk_is_that_in_memory() {
    // Tiles have 256 cells per side.
    compare(600, 530, "bed", None);
    compare(300, 800, "surface", None);
}

#[test]
#[ignore = "long: 16384 x 16384 samples, in memory and on disk"]
fn a_large_map_is_drained_in_a_gibibyte() {
    compare(16384, 16384, "surface", Some(1 << 30));
    compare(16384, 16384, "bed", Some(1 << 30));
}
