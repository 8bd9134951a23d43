//! `orogen tilemap`.

use crate::harness::{Folder, png};

const FILES: [&str; 10] = [
    "classes.csv",
    "map.ldtk",
    "map.tmj",
    "map.tmx",
    "map.tscn",
    "preview.png",
    "tilemap.json",
    "tiles.png",
    "tiles.tres",
    "tiles.tsx",
];

/// A world of 40 x 30 cells whose classes are 0 to 5 from west to east, with single cells of water.
const CLASSES: &str = r#"
orogen = 1
world = { size = [400, 300], cell = 10 }
outputs = { class = "class" }
nodes.east = { op = "ramp", origin = [0, 0], length = 400, azimuth = 90 }
nodes.spots = { op = "white", seed = 3 }
nodes.class = { op = "expr", expr = "min(5, floor(east * 6)) * (spots < 0.9)" }
"#;

/// The rows of `classes.csv`.
fn classes(folder: &Folder, name: &str) -> Vec<Vec<u8>> {
    let text = folder.text(name);
    text.lines().map(|line| line.split(',').map(|class| class.parse().unwrap()).collect()).collect()
}

#[test]
fn it_writes_its_files_and_they_agree() {
    let folder = Folder::new();
    folder.write("land.toml", CLASSES);
    for (layout, tiles, cells) in [
        ("blob", [40, 30], [40, 30]),
        ("edge", [40, 30], [40, 30]),
        ("corner", [40, 30], [41, 31]),
        ("dual", [41, 31], [40, 30]),
    ] {
        let outcome = folder.good(&["tilemap", "land.toml", "--cell", "10", "--layout", layout, "-o", layout]);
        assert_eq!(folder.names(layout), FILES);
        let text = outcome.text();
        assert!(text.contains(&format!("{} x {} tiles of fields-16 ({layout})", tiles[0], tiles[1])), "{text}");
        assert!(text.contains("every place has a tile"), "{text}");
        let summary = folder.json(&format!("{layout}/tilemap.json"));
        assert_eq!((&summary["width"], &summary["height"]), (&tiles[0].into(), &tiles[1].into()));
        let table = classes(&folder, &format!("{layout}/classes.csv"));
        assert_eq!([table[0].len(), table.len()], cells);
        for (class, counted) in summary["classes"].as_array().unwrap().iter().enumerate() {
            let cells = table.iter().flatten().filter(|of| usize::from(**of) == class).count();
            assert_eq!(counted["cells"], cells, "{counted}");
        }
        let picture = png(&folder.read(&format!("{layout}/preview.png")));
        assert_eq!([picture.width, picture.height], tiles.map(|side| side * 16));
        // Every tile number of the map is one of the tileset.
        let map = folder.json(&format!("{layout}/map.tmj"));
        let count = map["tilesets"][0]["tilecount"].as_u64().unwrap();
        for layer in map["layers"].as_array().unwrap() {
            let data = layer["data"].as_array().unwrap();
            assert_eq!(data.len(), tiles[0] * tiles[1]);
            assert!(data.iter().all(|tile| tile.as_u64().unwrap() <= count));
        }
    }
}

#[test]
fn a_part_of_a_map_is_the_map_there() {
    let folder = Folder::new();
    folder.write("land.toml", CLASSES);
    folder.good(&["tilemap", "land.toml", "--cell", "10", "-o", "whole", "-q"]);
    folder.good(&["tilemap", "land.toml", "--window", "7,5,20,11", "-o", "part", "-q"]);
    let [whole, part] = ["whole", "part"].map(|name| folder.json(&format!("{name}/map.tmj")));
    let layer = |map: &serde_json::Value, name: &str| -> Vec<u64> {
        let layers = map["layers"].as_array().unwrap();
        let found = layers.iter().find(|layer| layer["name"] == name);
        found.map_or(Vec::new(), |layer| {
            layer["data"].as_array().unwrap().iter().map(|tile| tile.as_u64().unwrap()).collect()
        })
    };
    for name in ["water", "sand", "grass", "forest", "rock"] {
        let [whole, part] = [layer(&whole, name), layer(&part, name)];
        assert!(!whole.is_empty(), "{name}");
        for (y, row) in part.chunks(20).enumerate() {
            assert_eq!(row, &whole[(y + 5) * 40 + 7..][..20], "{name}, row {y}");
        }
    }
}

#[test]
fn another_seed_is_another_map_of_the_same_look() {
    let folder = Folder::with_small();
    folder.good(&["tilemap", "small.toml", "--size", "32x24", "--seed", "1..2", "-o", "map", "-q"]);
    let [one, two] = ["map-1", "map-2"].map(|name| folder.read(&format!("{name}/classes.csv")));
    assert_ne!(one, two);
    assert_eq!(folder.read("map-1/tiles.png"), folder.read("map-2/tiles.png"));
}

/// Grass with sand at its lower end, and exactly a third of water, in a different order than in the tileset.
const SHARES: &str = r#"
[[class]]
name = "grass"
[[class]]
name = "sand"
height = { max = 60 }
[[class]]
name = "water"
share = { of = "height", lowest = 0.3333 }
"#;

#[test]
fn classes_of_a_recipe_are_terrains_by_name_and_shares_are_exact() {
    let folder = Folder::new();
    let recipe = format!("{}{SHARES}", crate::harness::SMALL);
    folder.write("land.toml", &recipe);
    for (cell, cells) in [("10", 64 * 48), ("20", 32 * 24), ("5", 128 * 96), ("13", 49 * 37)] {
        for seed in ["1", "2"] {
            folder.good(&["tilemap", "land.toml", "--cell", cell, "--seed", seed, "-o", "map", "-q", "--force"]);
            let table = classes(&folder, "map/classes.csv");
            let count = |class: u8| table.iter().flatten().filter(|of| **of == class).count();
            assert_eq!(count(0), (0.3333 * f64::from(cells)).round() as usize, "{cell} m, seed {seed}");
            assert_eq!(count(0) + count(1) + count(2), cells as usize);
        }
    }
    folder.good(&["tilemap", "land.toml", "--cell", "10", "-o", "whole", "-q"]);
    folder.good(&["tilemap", "land.toml", "--cell", "10", "--window", "11,7,30,20", "-o", "part", "-q"]);
    let [whole, part] = ["whole", "part"].map(|name| classes(&folder, &format!("{name}/classes.csv")));
    for (row, cells) in part.iter().enumerate() {
        assert_eq!(cells, &whole[row + 7][11..41]);
    }
    folder.write("lava.toml", recipe.replace("\"sand\"", "\"lava\""));
    let outcome = folder.bad(
        &["tilemap", "lava.toml", "-o", "x"],
        2,
        "the class `lava` is no terrain of the tileset `fields-16`",
    );
    assert!(outcome.err.contains("water, sand, grass, forest, rock, snow"), "{}", outcome.err);
    folder.write("both.toml", recipe.replace("noise = \"noise\"", "class = \"noise\""));
    folder.bad(&["tilemap", "both.toml", "-o", "x"], 1, "tables `[[class]]` and an output `class`");
}

#[test]
fn wrong_classes_and_sizes_are_explained() {
    let folder = Folder::new();
    folder.write("wrong.toml", CLASSES.replace("min(5,", "min(7,").replace("east * 6", "east * 8"));
    let outcome =
        folder.bad(&["tilemap", "wrong.toml", "--cell", "10", "-o", "x"], 2, "the output `class` is 6 in column");
    assert!(outcome.err.contains("0 water, 1 sand, 2 grass, 3 forest, 4 rock, 5 snow"), "{}", outcome.err);
    folder.write("half.toml", CLASSES.replace("* (spots", "+ 0.5 * (spots"));
    folder.bad(&["tilemap", "half.toml", "--cell", "10", "-o", "x"], 2, "is 0.5 in column 0, row");
    folder.write("none.toml", CLASSES.replace("class = \"class\" }", "other = \"class\" }"));
    folder.bad(&["tilemap", "none.toml", "--cell", "10", "-o", "x"], 1, "no output `height` and no output `class`");
    folder.write("land.toml", CLASSES);
    folder.bad(&["tilemap", "land.toml", "--size", "0", "-o", "x"], 2, "--size");
    folder.bad(&["tilemap", "land.toml", "--tileset", "none", "-o", "x"], 2, "fields-16");
    for command in ["tilemap", "blocks"] {
        let out = ["-o", if command == "blocks" { "x.vox" } else { "x" }];
        let said = "the standard terrain classes need a cell of 0.0001 m to 400000 m, not 1000000000 m";
        folder.bad(&[&[command, "endless", "--cell", "1e9"][..], &out].concat(), 2, said);
    }
    assert!(!folder.path("x").exists(), "nothing is left behind");
}

#[test]
fn a_map_that_was_edited_is_kept() {
    let folder = Folder::with_small();
    let arguments = ["tilemap", "small.toml", "--size", "32x24", "-o", "map", "-q"];
    folder.good(&arguments);
    folder.good(&arguments);
    // An editor writes the file again, without the comment at its beginning.
    let edited = folder.text("map/map.tmx");
    let edited: String = edited.lines().filter(|line| !line.contains("<!--")).map(|line| format!("{line}\n")).collect();
    folder.write("map/map.tmx", &edited);
    folder.bad(&arguments, 1, "map.tmx");
    assert_eq!(folder.read("map/map.tmx"), edited.as_bytes());
}

#[test]
fn tilesets_from_files_are_used_and_kept() {
    let folder = Folder::new();
    // Single cells of land, for which the file has no tile, because no wang set can have one.
    folder.write("land.toml", CLASSES.replace("spots < 0.9", "spots > 0.9"));
    let arguments = |tileset: &'static str, out: &'static str| {
        ["tilemap", "land.toml", "--cell", "10", "--tileset", tileset, "-o", out]
    };
    folder.good(&arguments("fields-16", "own"));
    let outcome = folder.good(&arguments("own/tiles.tsx", "again"));
    assert!(outcome.text().contains("of fields-16 (blob)"), "{}", outcome.text());
    assert_eq!(folder.read("again/tiles.png"), folder.read("own/tiles.png"));
    assert!(folder.json("again/tilemap.json")["changed"].as_u64().unwrap() > 0);

    folder.bad(&arguments("own/tiles.tsx", "own"), 1, "tiles.png: this command reads that file");
    folder.bad(&arguments("none.tsx", "x"), 1, "none.tsx");
    let one = ["tilemap", "land.toml", "--tileset", "own/tiles.tsx", "--wang-set", "lava", "-o", "x"];
    folder.bad(&one, 1, "no wang set `lava`; it has `water`, `sand`");
    let program = ["tilemap", "land.toml", "--wang-set", "sand", "-o", "x"];
    folder.bad(&program, 2, "--wang-set needs a file as --tileset");
    folder.write("rows.toml", "picture = \"own/tiles.png\"\nsize = 16\nlayout = \"rule\"\n[[class]]\nname = \"a\"\nfull = [0]\n[[class.rule]]\npattern = [\"##\"]\ntiles = [1]");
    folder.bad(&arguments("rows.toml", "x"), 1, "needs three rows of three characters");
    assert!(!folder.path("x").exists(), "nothing is left behind");
}

#[test]
fn infinite_maps_have_chunks_at_the_cells_of_the_world() {
    let folder = Folder::new();
    folder.write("land.toml", CLASSES);
    folder.good(&["tilemap", "land.toml", "--window", "7,5,20,11", "--infinite", "-o", "part", "-q"]);
    folder.good(&["tilemap", "land.toml", "--cell", "10", "-o", "whole", "-q"]);
    let [whole, part] = ["whole", "part"].map(|name| folder.json(&format!("{name}/map.tmj")));
    assert_eq!((&whole["infinite"], &part["infinite"]), (&false.into(), &true.into()));
    let water = |map: &serde_json::Value| {
        let layers = map["layers"].as_array().unwrap();
        layers.iter().find(|layer| layer["name"] == "water").unwrap().clone()
    };
    // Readers such as Phaser's allocate space from the start of a layer to its end.
    for (key, value) in [("startx", 0), ("starty", 0), ("width", 32), ("height", 16)] {
        assert_eq!(water(&part)[key], value, "{key}");
    }
    assert!(folder.text("part/map.tmx").contains(" tiledversion=\"") && part["tiledversion"].is_string());
    let (whole, part) = (water(&whole), water(&part));
    let chunks = part["chunks"].as_array().unwrap();
    let places: Vec<_> =
        chunks.iter().map(|chunk| (chunk["x"].as_i64().unwrap(), chunk["y"].as_i64().unwrap())).collect();
    assert_eq!(places, [(0, 0), (16, 0)]);
    for (chunk, (left, top)) in chunks.iter().zip(places) {
        for (place, tile) in chunk["data"].as_array().unwrap().iter().enumerate() {
            let [x, y] = [left as usize + place % 16, top as usize + place / 16];
            let is_inside = (7..27).contains(&x) && (5..16).contains(&y);
            let expected = if is_inside { whole["data"][y * 40 + x].clone() } else { 0.into() };
            assert_eq!(*tile, expected, "{x}, {y}");
        }
    }
}
