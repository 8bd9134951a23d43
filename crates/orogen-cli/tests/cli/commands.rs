//! Tables of all commands. Tests of requirements for every command iterate over them. A command that is missing from
//! all tables fails a test here.

use std::collections::BTreeSet;
use std::sync::OnceLock;

use crate::harness::Folder;

/// A command that writes files.
pub struct Writer {
    /// The arguments; the output path is last.
    pub arguments: &'static [&'static str],
    /// The files that it writes and that contain user data.
    pub files: &'static [&'static str],
}

const fn writer(arguments: &'static [&'static str], files: &'static [&'static str]) -> Writer {
    Writer { arguments, files }
}

/// Every command that writes files, in each variant. They run in a folder made by [`workplace`].
pub const WRITERS: &[Writer] = &[
    writer(
        &["generate", "small.toml", "-o", "made"],
        &["made/height.png", "made/height8.png", "made/map.png", "made/recipe.toml", "made/summary.json"],
    ),
    writer(&["export", "small.toml", "-o", "a.tif"], &["a.tif"]),
    writer(&["export", "small.toml", "-o", "a.asc"], &["a.asc"]),
    writer(&["export", "small.toml", "-o", "a.npy"], &["a.npy"]),
    writer(&["export", "small.toml", "-o", "a.exr"], &["a.exr"]),
    writer(&["export", "small.toml", "-o", "a.pgm"], &["a.pgm"]),
    writer(&["export", "small.toml", "-o", "a.png"], &["a.png", "a.json"]),
    writer(&["export", "small.toml", "-o", "a.r16"], &["a.r16", "a.json"]),
    writer(&["export", "small.toml", "-o", "a.r32"], &["a.r32", "a.json"]),
    writer(&["export", "small.toml", "-o", "a.obj"], &["a.obj", "a.mtl", "a-texture.png"]),
    writer(&["export", "small.toml", "-o", "a.ply"], &["a.ply"]),
    writer(&["export", "small.toml", "-o", "a.stl"], &["a.stl"]),
    writer(&["export", "small.toml", "-o", "a.3mf"], &["a.3mf"]),
    writer(&["export", "small.toml", "-o", "a.glb"], &["a.glb"]),
    writer(&["export", "small.toml", "-o", "a.svg"], &["a.svg"]),
    writer(&["export", "small.toml", "-o", "a.geojson"], &["a.geojson"]),
    writer(
        &["export", "small.toml", "--target", "unity", "--size", "33", "--tiles", "2x1", "-o", "u.r16"],
        &["u_0_0.r16", "u_1_0.r16"],
    ),
    writer(
        &["export", "small.toml", "--layer", "splat", "--preview", "-o", "w.png"],
        &["w.png", "w_2.png", "w_preview.png", "w.json"],
    ),
    writer(&["build", "small.toml", "--force", "-o", "b.tif"], &["b.tif"]),
    writer(&["build", "small.toml", "--force", "-o", "b.pmtiles"], &["b.pmtiles"]),
    writer(&["analyze", "small.toml", "--cell", "5", "-o", "page.png"], &["page.png"]),
    writer(&["fit", "place.tif", "--tries", "12", "--judges", "1", "-o", "like.toml"], &["like.toml"]),
    writer(&["refine", "place.tif", "--cell", "15", "-o", "fine.tif"], &["fine.tif"]),
    writer(&["refine", "place.tif", "--cell", "15", "-o", "fine.toml"], &["fine.toml"]),
    writer(&["grow", "rivers.toml", "--frames", "2", "-o", "grow.png"], &["grow.png"]),
    writer(&["grow", "rivers.toml", "--frames", "2", "-o", "grow.gif"], &["grow.gif"]),
    writer(&["grow", "rivers.toml", "--frames", "2", "-o", "grow-%d.png"], &["grow-0.png", "grow-1.png"]),
    writer(&["render", "small.toml", "--size", "64x36", "-o", "view.png"], &["view.png"]),
    writer(
        &["render", "small.toml", "--size", "64x36", "--turntable", "2", "-o", "view-%02d.png"],
        &["view-00.png", "view-01.png"],
    ),
    writer(&["map", "small.toml", "--dpi", "30", "-o", "map.png"], &["map.png"]),
    writer(&["map", "small.toml", "--dpi", "30", "-o", "map.svg"], &["map.svg"]),
    writer(&["map", "small.toml", "--dpi", "30", "-o", "map.pdf"], &["map.pdf"]),
    writer(
        &["tilemap", "small.toml", "--size", "32x24", "-o", "tiles"],
        &[
            "tiles/tiles.png",
            "tiles/tiles.tsx",
            "tiles/map.tmx",
            "tiles/map.tmj",
            "tiles/classes.csv",
            "tiles/preview.png",
            "tiles/tilemap.json",
        ],
    ),
    writer(&["blocks", "small.toml", "--size", "32x24", "-o", "b.vox"], &["b.vox"]),
    writer(&["blocks", "small.toml", "--size", "32x24", "-o", "b.schem"], &["b.schem"]),
    writer(&["blocks", "small.toml", "--size", "32x24", "-o", "b.glb"], &["b.glb"]),
    writer(&["blocks", "small.toml", "--size", "32x24", "-o", "b.png"], &["b.png"]),
    writer(
        &["blocks", "small.toml", "--size", "32x24", "-o", "world"],
        &[
            "world/worldmods/orogen_blocks/textures/orogen_blocks_grain.png",
            "world/worldmods/orogen_blocks/init.lua",
            "world/worldmods/orogen_blocks/mod.conf",
            "world/map_meta.txt",
            "world/world.mt",
            "world/map.sqlite",
        ],
    ),
    writer(
        &["blocks", "small.toml", "--size", "32x24", "--format", "minecraft", "-o", "save"],
        &["save/region/r.0.0.mca", "save/level.dat"],
    ),
    writer(&["variants", "small.toml", "--seeds", "2", "--size", "64", "-o", "variants.png"], &["variants.png"]),
    writer(&["noise", "perlin", "--size", "32", "-o", "noise.png"], &["noise.png"]),
    writer(&["noise", "perlin", "--size", "32", "-o", "noise.npy"], &["noise.npy"]),
    writer(&["noise", "perlin", "--size", "32", "--volume", "3", "-o", "block.npy"], &["block.npy"]),
    writer(&["noise", "perlin", "--size", "32", "--frames", "2", "-o", "n-%d.png"], &["n-0.png", "n-1.png"]),
    writer(&["compare", "--size", "120", "-o", "compare.png"], &["compare.png"]),
    writer(&["palettes", "-o", "palettes.png"], &["palettes.png"]),
    writer(&["graph", "hills", "-o", "graph.svg"], &["graph.svg"]),
    writer(&["graph", "hills", "-o", "graph.pdf"], &["graph.pdf"]),
    writer(&["graph", "hills", "-o", "graph.dot"], &["graph.dot"]),
];

/// Commands that only write text to standard output.
const TALKERS: &[&str] =
    &["presets", "ops", "schema", "explain", "check", "cache", "devices", "completions", "help", "locate"];

/// Commands that never overwrite files.
const STARTERS: &[&str] = &["new"];

/// A recipe with erosion.
const RIVERS: &str = r#"
orogen = 1
[world]
size = [600, 400]
cell = 20
[nodes.noise]
op = "fbm"
wavelength = 300
[nodes.land]
op = "stream-power"
source = "noise"
steps = 3
[outputs]
height = "land"
"#;

/// A folder with all inputs of the commands in [`WRITERS`].
pub fn workplace() -> Folder {
    let folder = Folder::with_small();
    folder.write("rivers.toml", RIVERS);
    folder
}

/// Writes an input that takes long to compute, only for commands that need it.
pub fn prepare(folder: &Folder, writer: &Writer) {
    static PLACE: OnceLock<Vec<u8>> = OnceLock::new();
    let made = || {
        let folder = Folder::with_solutions();
        folder.good(&["export", "hills", "-o", "place.tif", "--cell", "30", "--window", "100,120,96,80", "-q"]);
        folder.read("place.tif")
    };
    if writer.arguments.contains(&"place.tif") && !folder.path("place.tif").exists() {
        folder.write("place.tif", PLACE.get_or_init(made));
    }
}

/// The commands that the program itself lists.
pub fn listed() -> BTreeSet<String> {
    let help = Folder::new().good(&["--help"]).text().to_string();
    let commands = help.split("Commands:").nth(1).unwrap().split("Options:").next().unwrap();
    let names = commands.lines().filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    names.filter_map(|line| line.split_whitespace().next()).map(str::to_string).collect()
}

#[test]
fn every_command_is_in_a_table() {
    // `studio` opens a window: tests/cli/others.rs and the tests of orogen-studio. `serve` runs until it is
    // interrupted: tests/cli/serve.rs and the tests of orogen-serve.
    let writers = WRITERS.iter().map(|writer| writer.arguments[0]);
    let known: BTreeSet<String> = writers
        .chain(TALKERS.iter().chain(STARTERS).chain(&["serve", "studio"]).copied())
        .map(str::to_string)
        .collect();
    let missing: Vec<String> = listed().difference(&known).cloned().collect();
    assert!(missing.is_empty(), "add to the tables in tests/cli/commands.rs: {missing:?}");
}
