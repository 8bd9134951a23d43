//! `orogen new --map`.

use orogen::io::format::fmg::samples;

use crate::harness::Folder;

#[test]
fn a_map_becomes_a_world_that_can_be_checked_and_made() {
    let folder = Folder::new();
    folder.write("map.json", samples::map().to_string());
    let outcome = folder.good(&["new", "mine", "--map", "map.json", "--width", "41", "--seed", "7"]);
    for expect in ["wrote mine.toml", "41 x 21 km", "5 rivers, 1 lake, 2 settlements", "orogen generate mine.toml"] {
        assert!(outcome.text().contains(expect), "{expect}: {}", outcome.text());
    }
    assert!(outcome.err.contains("note: map.json: 1 river with fewer than two points left out"), "{}", outcome.err);
    assert!(folder.text("mine.toml").contains("seed = 7\n"));
    assert_eq!(folder.names(""), ["map.json", "mine", "mine.toml"]);
    folder.good(&["check", "mine.toml"]);
    folder.good(&["export", "mine.toml", "--window", "14km,8km,400m,400m", "--cell", "4", "-o", "a.tif"]);
    folder.good(&["map", "mine.toml", "--size", "300", "--names", "mine/places.csv", "-o", "map.png"]);
    folder.good(&["export", "mine.toml", "--size", "64", "--set", "coast_detail=0", "-o", "b.tif"]);
    // Nothing is replaced.
    let before = folder.text("mine.toml");
    folder.bad(&["new", "mine", "--map", "map.json"], 1, "mine/coast.geojson already exists and is left unchanged");
    assert_eq!(folder.text("mine.toml"), before);
}

#[test]
fn a_map_on_standard_input_makes_the_same_world() {
    let folder = Folder::new();
    folder.write("map.json", samples::map().to_string());
    let piped = |name: &str, content: &str| {
        let file = std::fs::File::open(folder.path(content)).unwrap();
        folder.command(&["new", name, "--map", "-", "--width", "41"]).stdin(file).output().unwrap()
    };
    folder.good(&["new", "mine", "--map", "map.json", "--width", "41"]);
    let outcome = piped("piped", "map.json");
    assert!(outcome.status.success(), "{}", String::from_utf8_lossy(&outcome.stderr));
    assert!(String::from_utf8_lossy(&outcome.stderr).contains("note: standard input: 1 river"));
    assert_eq!(folder.text("piped.toml"), folder.text("mine.toml").replace("mine", "piped"));
    assert_eq!(folder.names("piped"), folder.names("mine"));
    let outcome = piped("none", "mine.toml");
    assert_eq!(outcome.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&outcome.stderr).contains("cannot read standard input: "));
}

#[test]
fn maps_that_cannot_be_read_leave_no_files() {
    let folder = Folder::new();
    folder.write("map.json", "{}");
    folder.write("saved.map", "1.99|of the tool");
    for (arguments, code, expect) in [
        (&["new", "a", "--map", "none.json"][..], 1, "cannot read the map none.json"),
        (&["new", "a", "--map", "map.json"], 1, "cannot read map.json: it has no cells"),
        (&["new", "a", "--map", "saved.map"], 1, "a .map file is only read by Azgaar's Fantasy Map Generator"),
        (&["new", "-", "--map", "map.json"], 2, "give a name in place of `-`"),
        (&["new", "a", "--map", "map.json", "--width", "0"], 2, "a number of kilometres from 1 to 40000"),
        (&["new", "a", "--map", "map.json", "--preset", "hills"], 2, "cannot be used with"),
        (&["new", "a", "--width", "10"], 2, "--map"),
        (&["new", "none/a", "--map", "map.json"], 1, "cannot read map.json"),
    ] {
        folder.bad(arguments, code, expect);
    }
    assert_eq!(folder.names(""), ["map.json", "saved.map"]);
}
