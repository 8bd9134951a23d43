//! The common options for selecting samples and worlds.

use crate::harness::{Folder, npy};

#[test]
fn export_in_a_size_of_its_own() {
    let folder = Folder::with_small();
    let told = folder.good(&["export", "small.toml", "-o", "a.npy", "--size", "32"]).text().to_string();
    assert!(told.contains("32 x 24 samples of 20 m"), "{told}");
    folder.good(&["export", "small.toml", "-o", "b.npy", "--cell", "20", "-q"]);
    assert!(folder.read("a.npy") == folder.read("b.npy"));
    folder.bad(&["export", "small.toml", "-o", "c.npy", "--size", "32", "--cell", "20"], 2, "leave out one of them");
    folder.bad(
        &["export", "small.toml", "-o", "c.npy", "--size", "30x30"],
        2,
        "the nearest sizes that do are 30x23 and 40x30",
    );
    // The size for an engine is the length of one side.
    folder.bad(
        &["export", "small.toml", "-o", "c.png", "--size", "33x65", "--target", "unity"],
        2,
        "unity only takes square terrains",
    );
    // Numbers are rounded for display.
    let told = folder.good(&["export", "small.toml", "-o", "d.npy", "--size", "3"]).text().to_string();
    assert!(told.contains("3 x 2 samples of 213.333 m, "), "{told}");
}

#[test]
fn one_part_in_samples_metres_and_coordinates() {
    let folder = Folder::with_small();
    let export = |out: &str, options: &[&str]| {
        folder.good(&[&["export", "small.toml", "-q", "-o", out][..], options].concat());
        folder.read(out)
    };
    let expect = export("a.npy", &["--window", "10,20,30,15"]);
    for options in [
        &["--window", "100m,0.2km,300m,150m"][..],
        &["--bounds", "100,-350,400,-200"],
        &["--projwin", "100", "-200", "400", "-350"],
        &["--bounds", "100,-350,400,-200", "--size", "30x15"],
    ] {
        assert!(export("b.npy", options) == expect, "{options:?}");
    }
    for (options, expect) in [
        (&["--window", "0,0,5,5", "--bounds", "0,-1,1,0"][..], "cannot be used with"),
        (&["--bounds", "0,-1,1,0", "--projwin", "0", "1", "1", "0"], "cannot be used with"),
        (&["--window", "0,0,5,5", "--size", "10"], "leave out --size"),
        (&["--window", "0,0,5m,5m"], "mixes samples and metres"),
        (&["--window", "60,0,9,9"], "is not inside the world"),
        (
            &["--bounds", "0,0,100,100"],
            "not inside the world, which extends 640 m to the east and 480 m to the south of (0, 0)",
        ),
        (&["--bounds", "100,0,0,100"], "the west, 100, must be less than the east, 0"),
        (&["--projwin", "0", "0", "100"], "4 values required"),
        (&["--bounds", "1,-9,9,-1"], "the window of 8 x 8 m contains no sample at a cell size of 10 m"),
    ] {
        folder.bad(&[&["export", "small.toml", "-o", "c.npy"][..], options].concat(), 2, expect);
    }
    // The same options in every command.
    for command in [
        &["generate", "-o", "made"][..],
        &["map", "-o", "m.png", "--size", "300"],
        &["render", "-o", "r.png", "--size", "64x36"],
        &["build", "-o", "b.tif"],
        &["explain"],
    ] {
        let part = ["small.toml", "--bounds", "100,-350,400,-200"];
        let outcome = folder.good(&[command, &part].concat());
        assert!(outcome.text().contains("30 x 15") || command == ["explain"], "{command:?}: {}", outcome.text());
    }
    folder.bad(&["analyze", "small.toml", "--bounds", "100,-350,400,-200"], 2, "there is too little land to measure");
}

#[test]
fn a_world_on_a_map_carries_its_coordinates() {
    let folder = Folder::with_small();
    let place = ["--crs", "EPSG:32632", "--origin", "600000,5200000"];
    folder.good(&[&["export", "small.toml", "-q", "-o", "a.tif"][..], &place].concat());
    folder.good(&["export", "a.tif", "-q", "-o", "a.asc"]);
    let head: Vec<String> = folder.text("a.asc").lines().take(5).map(String::from).collect();
    assert_eq!(head, ["ncols 64", "nrows 48", "xllcenter 600000", "yllcenter 5199530", "cellsize 10"]);
    folder.good(&[&["export", "small.toml", "-q", "-o", "c.geojson"][..], &place].concat());
    assert!(folder.text("c.geojson").contains("urn:ogc:def:crs:EPSG::32632"));
    // A file of heights has a CRS and therefore bounds. The bounds of its pixel edges, as printed by gdalinfo, select
    // all of it.
    folder.good(&["export", "small.toml", "-q", "-o", "all.npy"]);
    folder.good(&["export", "a.tif", "-q", "-o", "b.npy", "--projwin", "599995", "5200005", "600635", "5199525"]);
    assert!(folder.read("b.npy") == folder.read("all.npy"));
    folder.good(&["export", "a.tif", "-q", "-o", "d.npy", "--bounds", "600100,5199650,600400,5199800"]);
    folder.good(&["export", "small.toml", "-q", "-o", "e.npy", "--window", "10,20,30,15"]);
    assert!(folder.read("d.npy") == folder.read("e.npy"));
    // The recipe written by `generate` keeps the position.
    folder.good(&[&["generate", "small.toml", "-q", "-o", "made"][..], &place].concat());
    folder.good(&["export", "made/recipe.toml", "-q", "-o", "f.tif", "--cell", "10"]);
    assert!(folder.read("f.tif") == folder.read("a.tif"));
    for (recipe, options, code, expect) in [
        ("a.tif", &["--bounds", "11,46,12,47"][..], 2, "extends over 600000,5199520,600640,5200000 in EPSG:32632"),
        ("a.tif", &["--crs", "EPSG:32633"], 1, "the file of heights is in EPSG:32632, but `crs` is EPSG:32633"),
        ("a.tif", &["--crs", "EPSG:32632", "--origin", "1,2"], 1, "leave out `origin`"),
        ("small.toml", &["--crs", "EPSG:32632"], 1, "`origin` is missing"),
        ("small.toml", &["--origin", "1,2"], 1, "`crs` is missing"),
        ("small.toml", &["--crs", "EPSG:1"], 2, "unknown coordinate reference system EPSG:1"),
        ("small.toml", &["--crs", "utm"], 2, "write its EPSG code"),
        ("small.toml", &["--origin", "north"], 2, "a position must be EAST,NORTH"),
    ] {
        folder.bad(&[&["export", recipe, "-o", "x.tif"][..], options].concat(), code, expect);
    }
    folder.write(
        "bad.toml",
        "orogen = 1\n[world]\ncrs = 5\norigin = [1]\n[nodes.a]\nop = \"constant\"\n[outputs]\nheight = \"a\"\n",
    );
    let told = folder.bad(&["generate", "bad.toml"], 1, "bad.toml:3:7: `crs` must be an EPSG code in quotes");
    assert!(told.err.contains("bad.toml:4:10: `origin` must be"), "{}", told.err);
}

#[test]
fn several_seeds_make_an_output_each() {
    let folder = Folder::with_small();
    folder.good(&["export", "small.toml", "-o", "a.npy", "--size", "16", "--seed", "3..4,9", "-q"]);
    folder.good(&["export", "small.toml", "-o", "one.npy", "--size", "16", "--seed", "9", "-q"]);
    folder.good(&["generate", "small.toml", "-o", "worlds-{seed}-made", "--size", "16", "--seed", "1,2", "-q"]);
    let names = ["a-3.npy", "a-4.npy", "a-9.npy", "one.npy", "small.toml", "worlds-1-made", "worlds-2-made"];
    assert_eq!(folder.names(""), names);
    assert!(folder.read("a-9.npy") == folder.read("one.npy") && folder.read("a-3.npy") != folder.read("a-4.npy"));
    assert_eq!(npy(&folder.read("a-4.npy")).width(), 16);
    for seed in [1, 2] {
        assert_eq!(folder.json(&format!("worlds-{seed}-made/summary.json"))["seed"], seed);
    }
    for command in [
        &["map", "-o", "m.png", "--size", "200"][..],
        &["render", "-o", "r.png", "--size", "64x36"],
        &["build", "-o", "b.tif"],
        &["explain"],
    ] {
        folder.good(&[command, &["small.toml", "--seed", "5,6"]].concat());
    }
    for name in ["m-5.png", "m-6.png", "r-5.png", "r-6.png", "b-5.tif", "b-6.tif"] {
        assert!(folder.path(name).exists(), "{name}");
    }
    for (arguments, expect) in [
        (&["--seed", "1,1", "-o", "x.npy"][..], "the seed 1 is listed twice"),
        (&["--seed", "1,2", "-o", "-"], "cannot be written to one stream"),
        (&["-o", "x-{seed}.npy"], "needs --seed, such as --seed 1..9"),
        (&["--seed", "3..1", "-o", "x.npy"], "write the lower seed first"),
    ] {
        folder.bad(&[&["export", "small.toml"][..], arguments].concat(), 2, expect);
    }
}
