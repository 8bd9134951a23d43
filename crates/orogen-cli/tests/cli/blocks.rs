//! `orogen blocks`.

use crate::harness::{Folder, png};

/// A world of 60 x 40 blocks with sea, beach, hills and rock.
const HILLS: &str = r#"
orogen = 1
world = { size = [60, 40], cell = 1 }
outputs = { height = "height" }
nodes.noise = { op = "fbm", wavelength = 30, seed = 4 }
nodes.height = { op = "expr", expr = "noise * 24 + 2" }
"#;

/// The size and the number of voxels of the first model of a .vox file.
fn vox(file: &[u8]) -> ([u32; 3], u32) {
    let four = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap());
    assert_eq!((&file[20..24], &file[44..48]), (&b"SIZE"[..], &b"XYZI"[..]));
    ([four(32), four(36), four(40)], four(56))
}

#[test]
fn a_small_world_has_a_block_for_each_cell() {
    let folder = Folder::new();
    folder.write("hills.toml", HILLS);
    let outcome = folder.good(&["blocks", "hills.toml"]);
    assert!(outcome.text().contains("60 x 40 columns") && outcome.text().contains("1 m a block"), "{}", outcome.text());
    let file = folder.read("blocks.vox");
    let ([east, north, up], voxels) = vox(&file);
    assert_eq!([east, north], [60, 40]);
    assert!(up > 20 && voxels > 60 * 40 * 16, "{up} {voxels}");
    // More levels below the ground give more blocks, and the same ones above.
    folder.good(&["blocks", "hills.toml", "--below", "20", "-o", "deep.vox", "-q"]);
    let (size, more) = vox(&folder.read("deep.vox"));
    assert_eq!((size, more), ([60, 40, up + 4], voxels + 4 * 60 * 40));
    let picture = folder.good(&["blocks", "hills.toml", "--format", "png", "-o", "-"]);
    assert_eq!(png(&picture.out).width, 100 * 8);
}

#[test]
fn every_format_tells_what_it_made_and_another_seed_is_another_map() {
    let folder = Folder::new();
    folder.write("hills.toml", HILLS);
    for out in ["b.schem", "b.vox", "b.png", "b", "save --format minecraft"] {
        let arguments = [&["blocks", "hills.toml", "-o"][..], &out.split(' ').collect::<Vec<_>>()].concat();
        let text = folder.good(&arguments).text().to_string();
        assert!(text.contains("% stone (") && text.contains("% water (") && text.contains("% sand ("), "{text}");
    }
    assert!(folder.good(&["blocks", "hills.toml", "-o", "b.glb"]).text().contains(" triangles in 1 part"));
    folder.good(&["blocks", "hills.toml", "--seed", "1..2", "-o", "b.schem", "-q"]);
    assert_ne!(folder.read("b-1.schem"), folder.read("b-2.schem"));
}

#[test]
fn exaggeration_caves_and_sections_are_of_any_recipe() {
    let folder = Folder::new();
    folder.write("hills.toml", HILLS);
    let levels = |arguments: &[&str]| {
        let outcome = folder.good(&[&["blocks", "hills.toml"], arguments].concat());
        let text = outcome.text();
        let words: Vec<&str> = text.split(' ').collect();
        let at = words.iter().position(|word| *word == "levels,").unwrap();
        (words[at - 1].parse::<u32>().unwrap(), text.to_string())
    };
    let (plain, text) = levels(&["-o", "a.vox"]);
    assert!(text.contains(" of air, 0 of them in caves and below overhangs\n"), "{text}");
    let blocks: u64 = text.lines().nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    let counts = text.lines().nth(1).unwrap().split('(').skip(1);
    assert_eq!(counts.map(|part| part.split(')').next().unwrap().parse::<u64>().unwrap()).sum::<u64>(), blocks);
    let air: u64 = text.lines().nth(2).unwrap().split(' ').next().unwrap().parse().unwrap();
    assert_eq!(blocks + air, 60 * 40 * u64::from(plain));
    assert!(levels(&["-o", "a.vox", "--exaggeration", "2"]).0 > plain * 5 / 4);
    let (deep, text) = levels(&["--caves", "--section", "row=12", "-o", "caves.png"]);
    assert!(deep >= plain + 28 && text.contains(" of them in caves") && !text.contains(" air, 0 of them"), "{text}");
    let picture = png(&folder.read("caves.png"));
    assert_eq!([picture.width, picture.height], [60 * 8, deep as usize * 8]);
    let section = |arguments: &[&str], expect: &str| {
        folder.bad(&[&["blocks", "hills.toml", "--section"], arguments].concat(), 2, expect);
    };
    section(&["row=12", "-o", "a.vox"], "--section draws a picture: name a .png");
    section(&["column=60", "-o", "b.png"], "there is no column 60 to cut along; the window has the columns 0 to 59");
    section(&["12", "-o", "b.png"], "it must be row=N or column=N");
    folder.bad(&["blocks", "hills.toml", "--exaggeration", "1000"], 2, "it must be a number from 0.01 to 100");
    folder.bad(&["blocks", "caves", "--caves"], 2, "the recipe has an output `density`");
}

#[test]
fn a_world_that_was_opened_is_kept() {
    let folder = Folder::new();
    folder.write("hills.toml", HILLS);
    folder.good(&["blocks", "hills.toml", "-o", "world", "-q"]);
    folder.good(&["blocks", "hills.toml", "-o", "world", "-q"]);
    folder.write("world/env_meta.txt", "game_time = 12\n");
    folder.bad(&["blocks", "hills.toml", "-o", "world", "-q"], 1, "Luanti has opened this world");
    folder.good(&["blocks", "hills.toml", "-o", "world", "-q", "--force"]);
}

#[test]
fn a_save_is_kept_where_it_was_opened_or_holds_another_part() {
    let folder = Folder::new();
    folder.write("hills.toml", HILLS.replace("[60, 40]", "[1200, 40]"));
    let make = |more: &[&'static str]| {
        let start = ["blocks", "hills.toml", "--cell", "1", "--format", "minecraft", "-o", "save", "-q", "--window"];
        [&start[..], more].concat()
    };
    folder.good(&make(&["500,0,30,20"]));
    assert_eq!(folder.names("save/region"), ["r.0.0.mca", "r.1.0.mca"]);
    let [first, second] = ["save/region/r.0.0.mca", "save/region/r.1.0.mca"].map(|name| folder.read(name));
    let sectors = |file: &[u8]| file[..4096].chunks(4).filter(|place| **place != [0; 4]).count();
    // The chunks that the window touches: 31 of the first region, 32 and 33 of the second; two rows of each.
    assert_eq!([sectors(&first), sectors(&second)], [2, 4]);
    folder.good(&[&make(&["500,0,30,20"])[..], &["--threads", "1"]].concat());
    assert!(folder.read("save/region/r.0.0.mca") == first, "the bytes depend on the number of threads");
    folder.bad(&make(&["1030,0,30,20"]), 1, "it has regions outside of this window");
    folder.good(&make(&["1030,0,30,20", "--force"]));
    assert_eq!(folder.names("save/region"), ["r.0.0.mca", "r.1.0.mca", "r.2.0.mca"]);
    folder.write("save/session.lock", "\u{2603}");
    folder.bad(&make(&["500,0,600,20"]), 1, "Minecraft has opened this save");
    folder.good(&make(&["500,0,600,20", "--force"]));
}

#[test]
fn land_that_is_too_high_for_minecraft_is_moved_or_scaled() {
    let folder = Folder::new();
    folder.write("high.toml", HILLS.replace("* 24 + 2", "* 24 + 400"));
    let save = |more: &[&'static str]| {
        [&["blocks", "high.toml", "--format", "minecraft", "-o", "save", "-q"][..], more].concat()
    };
    let message = folder.run(&save(&[])).err;
    let advice = message.split("use --sea-y ").nth(1).and_then(|rest| rest.split(',').next()).unwrap().to_string();
    folder.good(&[&save(&[])[..], &["--sea-y", &advice]].concat());
    folder.good(&save(&["--exaggeration", "0.5"]));
    folder.write("high.toml", HILLS.replace("* 24 + 2", "* 800"));
    folder.bad(&save(&["--force"]), 2, " or less, or a larger cell, and --sea-y to move it");
    folder.bad(&save(&["--force", "--below", "5"]), 2, "leave out --below");
}

#[test]
fn what_cannot_be_made_is_explained() {
    let folder = Folder::new();
    folder.write("hills.toml", HILLS);
    folder.bad(&["blocks", "hills.toml", "-o", "b.obj"], 2, "or a .vox, .schem, .glb or .png");
    folder.bad(&["blocks", "hills.toml", "--format", "vox", "-o", "b.schem"], 2, "--format does not match");
    folder.bad(&["blocks", "hills.toml", "--format", "luanti", "-o", "-"], 2, "name a folder");
    folder.bad(&["blocks", "hills.toml", "--below", "9999", "-o", "b.vox"], 2, "--below");
    folder.write("flat.toml", HILLS.replace("height = \"height\"", "class = \"height\""));
    folder.bad(&["blocks", "flat.toml", "-o", "b.vox"], 1, "no output `height`");
    folder.write("class.toml", HILLS.replace("height = \"height\" }", "height = \"height\", class = \"height\" }"));
    folder.bad(&["blocks", "class.toml", "-o", "b.vox"], 2, "it must be one of 0 water, 1 sand");
    folder.write("high.toml", HILLS.replace("* 24", "* 240000"));
    folder.bad(
        &["blocks", "high.toml", "-o", "b.schem", "--memory", "20GiB"],
        2,
        "at most 65535 blocks along each side",
    );
    folder.bad(&["blocks", "high.toml", "-o", "b", "--memory", "20GiB"], 2, "a world of Luanti ends 30911 blocks");
    folder.bad(&["blocks", "high.toml", "-o", "b.png", "--memory", "20GiB"], 2, "at most 8192 pixels along a side");
    assert_eq!(folder.names("").iter().filter(|name| !name.ends_with(".toml")).count(), 0);
}

#[test]
fn what_a_format_cannot_hold_is_refused_before_the_work() {
    let folder = Folder::new();
    folder.write("wide.toml", HILLS.replace("[60, 40]", "[2600, 40]"));
    let message = "a scene of MagicaVoxel has at most 2000 voxels along a side, and this one needs 2600 x 40 x 1;";
    folder.bad(&["blocks", "wide.toml", "--cell", "1", "-o", "wide.vox", "-q"], 2, message);
    folder.write("tall.toml", HILLS.replace("24 + 2", "2400 + 2"));
    folder.bad(&["blocks", "tall.toml", "--cell", "1", "-o", "tall.vox"], 2, "at most 2000 voxels along a side");
    // The levels are known before the density of the ground is computed, which would take minutes here.
    let deep = HILLS
        .replace("24 + 2", "2400000 + 2")
        .replace("height = \"height\" }", "height = \"height\", density = \"density\" }");
    folder.write("deep.toml", deep + "nodes.altitude = { op = \"altitude\" }\nnodes.density = { op = \"expr\", expr = \"height - altitude\" }\n");
    folder.bad(&["blocks", "deep.toml", "--cell", "1", "-o", "deep.vox"], 2, "at most 2000 voxels along a side");
    for height in ["1e29", "-1e29"] {
        folder.write("far.toml", HILLS.replace("* 24", &format!("* {height}")));
        let message = "blocks of 1 m reach up to 4194304 m from height 0; scale the heights, or use a larger cell";
        for out in ["far.vox", "far.schem", "far.glb", "far.png", "far", "far --format minecraft"] {
            let arguments = [&["blocks", "far.toml", "--cell", "1", "-o"][..], &out.split(' ').collect::<Vec<_>>()];
            folder.bad(&arguments.concat(), 2, message);
        }
    }
    assert_eq!(folder.names("."), ["deep.toml", "far.toml", "tall.toml", "wide.toml"]);
}
