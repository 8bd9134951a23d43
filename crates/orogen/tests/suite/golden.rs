//! Compares the bits of every op and every preset with stored hashes. `OROGEN_BLESS=1` updates them; a changed line
//! means changed terrain.

use crate::support;
use crate::support::{open, recipe_of, world_of};
use orogen::grid::analysis::summary;
use orogen::laws::at_level;
use orogen::node::Node;
use orogen::{Options, Progress, Window, World, presets};
use orogen_noise::Level;
use std::collections::BTreeMap;
use std::path::PathBuf;

fn golden(file: &str, made: &BTreeMap<String, String>) {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../golden").join(file);
    let text: String = made.iter().map(|(name, hash)| format!("{name} {hash}\n")).collect();
    if support::bless() {
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, text).unwrap();
        return;
    }
    let expected = std::fs::read_to_string(&path).unwrap_or_default();
    let expected: BTreeMap<&str, &str> = expected.lines().filter_map(|line| line.split_once(' ')).collect();
    let mut wrong = Vec::new();
    for (name, hash) in made {
        match expected.get(name.as_str()) {
            Some(before) if before == hash => {}
            Some(before) => wrong.push(format!("{name} makes {hash}, golden/{file} says {before}")),
            None => wrong.push(format!("{name} is not in golden/{file}")),
        }
    }
    wrong.extend(
        expected.keys().filter(|name| !made.contains_key(**name)).map(|name| format!("{name} is made no more")),
    );
    assert!(wrong.is_empty(), "{}\nif this change of terrain is meant: cargo xtask bless", wrong.join("\n"));
}

#[test]
fn every_op_makes_its_golden_bits_at_every_level() {
    for level in Level::available() {
        let mut made = BTreeMap::new();
        for node in Node::all() {
            let recipe = recipe_of(&node, world_of(10.24), false);
            let layers: Vec<&str> = recipe.outputs().collect();
            let window = Window::new(75, 63, 10.24).at(5, 9);
            let world = open(&recipe, 2);
            let grids = at_level(level, || world.grids(&layers, &window, &Progress::none()).unwrap()).unwrap();
            for (layer, grid) in layers.iter().zip(&grids) {
                let op = node.spec().op;
                let name = if *layer == "height" { op.to_string() } else { format!("{op}.{layer}") };
                made.insert(name, summary(grid.data(), 0.0).sha256);
            }
        }
        golden("ops.txt", &made);
    }
}

/// On two threads; `cargo xtask clients presets` makes them on one, too, and at every SIMD level.
#[test]
fn every_preset_makes_its_golden_bits() {
    let mut made = BTreeMap::new();
    for preset in presets::all() {
        let recipe = preset.recipe().unwrap_or_else(|error| panic!("{error}"));
        let options = Options { threads: Some(2), ..Options::default() };
        let world = World::with_options(recipe, options).unwrap();
        // An unbounded world: this number of samples at its own cell.
        let cell = world.recipe().world.cell;
        let window = world.window_fitting(256).unwrap_or(Window::new(256, 256, cell));
        let grid = world.window("height", &window).unwrap();
        made.insert(preset.name.to_string(), summary(grid.data(), 0.0).sha256);
    }
    golden("presets.txt", &made);
}
