//! Roads: `--layer roads`, and roads on maps.

use crate::harness::Folder;

const LAND: &str = r#"
orogen = 1
[world]
size = [1600, 1200]
cell = 10
sea_level = -100
[nodes.swells]
op = "fbm"
wavelength = 900
octaves = 4
[nodes.land]
op = "expr"
expr = "200 + 90 * swells"
[nodes.roads]
op = "roads"
source = "land"
places = [[[100, 100], [1500, 1100]], [[1500, 100], [200, 1000]]]
[outputs]
height = "roads"
kind = "roads.kind"
"#;

#[test]
fn roads_are_lines_with_their_grade() {
    let folder = Folder::new();
    folder.write("land.toml", LAND);
    folder.good(&["export", "land.toml", "-o", "roads.geojson", "--layer", "roads", "-q"]);
    let roads = folder.json("roads.geojson");
    let features = roads["features"].as_array().unwrap();
    assert!(features.len() >= 2);
    let mut length = [0.0; 2];
    for feature in features {
        let properties = &feature["properties"];
        assert!(["road", "bridge", "tunnel"].contains(&properties["kind"].as_str().unwrap()));
        assert!(properties["grade"].as_f64().unwrap() <= 0.08 && properties["steep"] == 0.0, "{properties}");
        assert_eq!(properties["node"], "roads");
        length[properties["road"].as_u64().unwrap() as usize - 1] += properties["length"].as_f64().unwrap();
        assert_eq!(feature["geometry"]["coordinates"][0].as_array().unwrap().len(), 3);
    }
    assert!(length[0] > 1700.0 && length[1] > 100.0, "{length:?}");
    // The parts in two windows are the whole.
    let parts: f64 = [("west.geojson", "0,0,80,121"), ("east.geojson", "80,0,81,121")]
        .map(|(name, window)| {
            folder.good(&["export", "land.toml", "-o", name, "--layer", "roads", "--window", window, "-q"]);
            let lengths = folder.json(name);
            let lengths = lengths["features"].as_array().unwrap().iter();
            lengths.map(|feature| feature["properties"]["length"].as_f64().unwrap()).sum::<f64>()
        })
        .iter()
        .sum();
    assert!((parts - length[0] - length[1]).abs() < 0.01, "{parts} {length:?}");
}

#[test]
fn maps_show_roads_unless_they_are_left_out() {
    let folder = Folder::new();
    folder.write("land.toml", LAND);
    folder.good(&["map", "land.toml", "-o", "with.svg", "--no-summits", "--size", "400", "-q"]);
    folder.good(&["map", "land.toml", "-o", "without.svg", "--no-summits", "--no-roads", "--size", "400", "-q"]);
    let red = "#c43428";
    assert!(folder.text("with.svg").contains(red) && !folder.text("without.svg").contains(red));
}

#[test]
fn what_cannot_be_built_is_said() {
    let folder = Folder::new();
    let wrong = |from: &str, to: &str| folder.write("wrong.toml", LAND.replace(from, to));
    wrong("[1500, 1100]", "[1700, 1100]");
    let export = ["export", "wrong.toml", "-o", "x.geojson", "--layer", "roads"];
    folder.bad(&export, 2, "place 2 of road 1 (1700, 1100) is outside of the world");
    wrong("places = [[[100, 100], [1500, 1100]], [[1500, 100], [200, 1000]]]", "");
    folder.bad(&export, 1, "`roads` needs places to connect");
    let bare = LAND.split("[nodes.roads]").next().unwrap();
    folder.write("wrong.toml", format!("{bare}\n[outputs]\nheight = \"land\"\n"));
    folder.bad(&export, 2, "the recipe has no roads; add a node with `op = \"roads\"`");
}
