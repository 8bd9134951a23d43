//! `orogen generate`.

use crate::harness::{Folder, npy, png};

const FILES: [&str; 5] = ["height.png", "height8.png", "map.png", "recipe.toml", "summary.json"];

#[test]
fn it_writes_its_files_and_they_agree() {
    let folder = Folder::with_small();
    let outcome = folder.good(&["generate", "small.toml", "-o", "a/b"]);
    assert_eq!(folder.names("a/b"), FILES);
    let text = outcome.text();
    assert!(text.contains("64 x 48 samples of 10 m") && text.contains("-50.0 to 200.0 m"), "{text}");
    assert_eq!(outcome.err, "");

    folder.good(&["export", "small.toml", "-o", "h.npy", "-q"]);
    let heights = npy(&folder.read("h.npy"));
    let summary = folder.json("a/b/summary.json");
    let expect = orogen::grid::analysis::summary(heights.data(), 0.0);
    assert_eq!(summary["sha256"], expect.sha256);
    assert_eq!((&summary["seed"], &summary["width"], &summary["height"]), (&3.into(), &64.into(), &48.into()));
    for (key, value) in [
        ("cell", 10.0),
        ("height_min", f64::from(expect.min)),
        ("height_max", f64::from(expect.max)),
        ("height_mean", expect.mean),
        ("land_share", expect.land_share),
    ] {
        assert!((summary[key].as_f64().unwrap() - value).abs() < 1e-4, "{key}");
    }
    assert!(summary["seconds"].as_f64().unwrap() > 0.0);

    let (min, max) = (f64::from(expect.min), f64::from(expect.max));
    let share = |h: &f32| (f64::from(*h) - min) / (max - min);
    let grey = png(&folder.read("a/b/height.png"));
    assert_eq!((grey.width, grey.height), (64, 48));
    let levels: Vec<u16> = heights.data().iter().map(|h| (share(h) * 65535.0).round() as u16).collect();
    assert_eq!(grey.grey16(), levels);
    let grey8 = png(&folder.read("a/b/height8.png"));
    assert_eq!((grey8.width, grey8.bits, grey8.channels), (64, 8, 1));
    let levels: Vec<u8> = heights.data().iter().map(|h| (share(h) * 255.0).round() as u8).collect();
    assert_eq!(grey8.data, levels);
    let map = png(&folder.read("a/b/map.png"));
    assert_eq!((map.width, map.height, map.bits, map.channels), (64, 48, 8, 3));
    // Pixels are blue exactly where the height is below the sea level.
    for (pixel, &height) in map.data.chunks_exact(3).zip(heights.data()) {
        assert_eq!(pixel[2] > pixel[1], height <= 0.0, "{pixel:?} at {height} m");
    }
}

#[test]
fn lakes_are_blue_on_the_map() {
    let folder = Folder::new();
    let head =
        "orogen = 1\n[world]\nsize = [640.0, 480.0]\ncell = 10.0\n[nodes.ground]\nop = \"fbm\"\nwavelength = 200.0\n";
    let nodes = "[nodes.land]\nop = \"expr\"\nexpr = \"500 + ground * 100\"\n[nodes.lakes]\nop = \"lakes\"\nsource = \"land\"\n";
    folder.write("land.toml", format!("{head}{nodes}[outputs]\nheight = \"lakes\"\nlakes = \"lakes.lake\"\n"));
    folder.good(&["generate", "land.toml", "-o", "a"]);
    folder.good(&["export", "land.toml", "--layer", "lakes", "-o", "lakes.npy", "-q"]);
    let (map, lakes) = (png(&folder.read("a/map.png")), npy(&folder.read("lakes.npy")));
    let wet = lakes.data().iter().filter(|depth| **depth > 0.0).count();
    assert!(wet > 20 && wet < 2000, "{wet} samples in lakes");
    for (pixel, &depth) in map.data.chunks_exact(3).zip(lakes.data()) {
        assert_eq!(pixel[2] > pixel[1], depth > 0.0, "{pixel:?} at a depth of {depth} m");
    }
}

#[test]
fn the_recipe_it_writes_makes_the_same_terrain() {
    let folder = Folder::with_small();
    folder.good(&["generate", "small.toml", "-o", "a", "--seed", "9223372036854775807"]);
    folder.good(&["generate", "a/recipe.toml", "-o", "b"]);
    let (a, b) = (folder.json("a/summary.json"), folder.json("b/summary.json"));
    assert_eq!((&a["seed"], &a["sha256"]), (&i64::MAX.into(), &b["sha256"]));
    assert_eq!(folder.text("a/recipe.toml"), folder.text("b/recipe.toml"));
    folder.good(&["generate", "small.toml", "-o", "c"]);
    assert_ne!(folder.json("c/summary.json")["sha256"], a["sha256"]);
}

#[test]
fn threads_and_memory_change_nothing() {
    let folder = Folder::with_small();
    let sha = |options: &[&str]| {
        folder.good(&[&["generate", "small.toml"][..], options].concat());
        folder.json("out/summary.json")["sha256"].clone()
    };
    assert_eq!(sha(&["--threads", "1"]), sha(&["--threads", "5", "--memory", "1GiB"]));
}

#[test]
fn every_preset_is_made() {
    let folder = Folder::with_solutions();
    // Presets with river erosion take longer: tests/suite/golden.rs of the library makes all presets.
    for name in
        ["archipelago", "caves", "classic", "endless", "hills", "island", "rolling", "tile-continent", "tile-island"]
    {
        folder.good(&["generate", name, "--size", "32", "-o", name, "-q"]);
        assert_eq!(folder.names(name), FILES);
    }
}

#[test]
fn without_a_recipe_it_is_the_default_preset_into_out() {
    let folder = Folder::with_solutions();
    folder.good(&["generate", "--size", "16"]);
    assert_eq!(folder.names(""), ["out"]);
    folder.good(&["generate", "alpine", "--size", "16", "-o", "same"]);
    assert_eq!(folder.text("out/recipe.toml"), folder.text("same/recipe.toml"));
}

#[test]
fn sizes_and_cells_choose_the_samples() {
    let folder = Folder::with_small();
    for (options, expect) in [
        (&["--size", "32"][..], (32, 24, 20.0)),
        (&["--size", "128x96"], (128, 96, 5.0)),
        (&["--cell", "20"], (32, 24, 20.0)),
        (&["--cell", "7"], (91, 69, 7.0)),
    ] {
        folder.good(&[&["generate", "small.toml", "-q"][..], options].concat());
        let summary = folder.json("out/summary.json");
        let got = (
            summary["width"].as_u64().unwrap(),
            summary["height"].as_u64().unwrap(),
            summary["cell"].as_f64().unwrap(),
        );
        assert_eq!(got, expect, "{options:?}");
    }
    // At twice the cell size, every second sample is identical.
    folder.good(&["export", "small.toml", "-o", "fine.npy", "--layer", "noise", "--cell", "5"]);
    folder.good(&["export", "small.toml", "-o", "coarse.npy", "--layer", "noise", "--cell", "10"]);
    let (fine, coarse) = (npy(&folder.read("fine.npy")), npy(&folder.read("coarse.npy")));
    assert!((0..coarse.height()).all(|j| (0..coarse.width()).all(|i| coarse[(i, j)] == fine[(2 * i, 2 * j)])));
}

#[test]
fn what_cannot_be_asked_for_is_usage() {
    let folder = Folder::with_small();
    for (options, expect) in [
        (&["--size", "32x32"][..], "does not have the aspect ratio"),
        (&["--size", "32", "--cell", "5"], "leave out one of them"),
        (&["--size", "0"], "1 to 1000000000 samples"),
        (&["--size", "-5"], "a size must be a number of samples"),
        (&["--size", "99999999999"], "1 to 1000000000 samples"),
        (&["--size", "many"], "a size must be a number of samples"),
        (&["--cell", "0"], "greater than 0 m"),
        (&["--cell", "-1"], "greater than 0 m"),
        (&["--cell", "nan"], "greater than 0 m"),
        (&["--cell", "inf"], "greater than 0 m"),
        (&["--cell", "5000"], "smaller cell"),
        (&["--cell", "1e-9"], "0.000001 to 1000000000000 m"),
        (&["--seed", "-1"], "a whole number from 0"),
        (&["--seed", "9223372036854775808"], "a whole number from 0"),
        (&["--seed", "1.5"], "a whole number from 0"),
        (&["--threads", "0"], "1..=1024"),
        (&["--memory", "lots"], "such as 512MiB"),
        (&["--memory", "0"], "at least 1 byte"),
        (&["--colour"], "unexpected argument"),
    ] {
        folder.bad(&[&["generate", "small.toml"][..], options].concat(), 2, expect);
        assert_eq!(folder.names(""), ["small.toml"], "{options:?}");
    }
}

#[test]
fn what_exceeds_memory_is_refused_with_what_it_needs() {
    let folder = Folder::with_small();
    folder.bad(&["generate", "small.toml", "--memory", "10kB"], 1, "of memory, and 9.8 KiB is allowed");
    folder.bad(&["generate", "small.toml", "--size", "100000000"], 1, "PiB of memory");
    assert_eq!(folder.names(""), ["small.toml"]);
}

#[test]
fn running_again_replaces_the_files_and_nothing_else() {
    let folder = Folder::with_small();
    folder.good(&["generate", "small.toml"]);
    let first = folder.json("out/summary.json")["sha256"].clone();
    folder.write("out/mine.txt", "keep");
    folder.write("out/map.png", [&folder.read("out/map.png")[..], &vec![7; 1 << 20]].concat());
    folder.good(&["generate", "small.toml", "--size", "16"]);
    assert_eq!(folder.names("out").len(), 6);
    assert_eq!((folder.text("out/mine.txt").as_str(), png(&folder.read("out/map.png")).width), ("keep", 16));
    assert_ne!(folder.json("out/summary.json")["sha256"], first);
    folder.good(&["generate", "small.toml"]);
    assert_eq!(folder.json("out/summary.json")["sha256"], first);
}

#[test]
fn quiet_says_nothing_and_json_is_the_summary() {
    let folder = Folder::with_small();
    let quiet = folder.good(&["generate", "small.toml", "--quiet"]);
    assert_eq!((quiet.text(), quiet.err.as_str()), ("", ""));
    for options in [&["--json"][..], &["--json", "--quiet"]] {
        let outcome = folder.good(&[&["generate", "small.toml"][..], options].concat());
        assert_eq!((outcome.text(), outcome.err.as_str()), (folder.text("out/summary.json").as_str(), ""));
    }
    let keys: Vec<String> = folder.json("out/summary.json").as_object().unwrap().keys().cloned().collect();
    for key in [
        "seed",
        "width",
        "height",
        "cell",
        "height_min",
        "height_max",
        "height_mean",
        "land_share",
        "seconds",
        "sha256",
    ] {
        assert!(keys.iter().any(|k| k == key), "{key}");
    }
}

#[test]
fn a_flat_world_says_so_and_is_black() {
    let folder = Folder::new();
    folder.write(
        "flat.toml",
        "orogen = 1\n[world]\nsize = [90, 90]\n[nodes.a]\nop = \"constant\"\nvalue = 5\n[outputs]\nheight = \"a\"\n",
    );
    let outcome = folder.good(&["generate", "flat.toml"]);
    assert!(outcome.text().contains("the terrain is flat"), "{}", outcome.text());
    assert!(png(&folder.read("out/height.png")).grey16().iter().all(|&level| level == 0));
}

#[test]
fn a_world_without_bounds_is_shown_from_its_origin() {
    let folder = Folder::new();
    folder.write(
        "open.toml",
        "orogen = 1\n[world]\ncell = 4\n[nodes.a]\nop = \"perlin\"\nwavelength = 100\n[outputs]\nheight = \"a\"\n",
    );
    folder.good(&["generate", "open.toml", "--size", "30x20"]);
    let summary = folder.json("out/summary.json");
    assert_eq!((&summary["width"], &summary["height"], &summary["cell"]), (&30.into(), &20.into(), &4.0.into()));
}

#[test]
fn a_file_wins_over_the_preset_of_its_name_and_a_folder_does_not() {
    let folder = Folder::with_small();
    std::fs::create_dir(folder.path("hills")).unwrap();
    let outcome = folder.good(&["generate", "hills", "--size", "16", "-o", "a", "-q"]);
    assert_eq!(outcome.err, "");
    std::fs::rename(folder.path("small.toml"), folder.path("mesa")).unwrap();
    let outcome = folder.good(&["generate", "mesa", "-o", "b"]);
    assert!(outcome.err.starts_with("note: reading the file mesa"), "{}", outcome.err);
    assert_eq!(folder.json("b/summary.json")["width"], 64);
}

#[test]
fn the_recipe_written_says_how_to_look_at_it_the_same_way() {
    let folder = Folder::with_small();
    let hash = |out: &str| {
        folder.text(&format!("{out}/summary.json")).lines().find(|l| l.contains("sha256")).map(str::to_string)
    };
    for (view, out) in [(&["--size", "37"][..], "a"), (&["--cell", "7"], "b"), (&[], "c")] {
        folder.good(&[&["generate", "small.toml", "-q", "-o", out], view].concat());
        let text = folder.text(&format!("{out}/recipe.toml"));
        let line = text.lines().next().unwrap();
        let (_, command) = line.split_once("orogen generate recipe.toml ").unwrap_or_else(|| panic!("{line}"));
        let recipe = format!("{out}/recipe.toml");
        let mut again = vec!["generate", &recipe, "-q", "-o", "again"];
        again.extend(command.split(' '));
        folder.good(&again);
        assert_eq!(hash(out), hash("again"), "{line}");
    }
}
