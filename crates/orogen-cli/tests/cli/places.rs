//! Import and export of real places: every format keeps the position.

use crate::harness::{Folder, npy};
use std::path::Path;

/// A file of heights from another program, in EPSG:32632.
fn corpus(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus/dem").join(name);
    path.to_string_lossy().into_owned()
}

#[test]
fn every_format_says_where_it_lies() {
    let folder = Folder::new();
    let source = corpus("f32-strips.tif");
    for (name, beside) in [
        ("a.asc", &["a.prj"][..]),
        ("b.png", &["b.json", "b.pgw", "b.png.aux.xml", "b.prj"]),
        ("c.pgm", &["c.json", "c.pgm.aux.xml", "c.prj", "c.wld"]),
        ("d.r16", &["d.json", "d.prj", "d.wld"]),
        ("e.r32", &["e.json", "e.prj", "e.wld"]),
        ("f.npy", &["f.json", "f.prj", "f.wld"]),
        ("g.exr", &["g.exr.aux.xml", "g.json", "g.prj", "g.wld"]),
    ] {
        let said = folder.good(&["export", &source, "-o", name]);
        let mut names = folder.names("");
        names.retain(|other| other.starts_with(&name[..1]) && other != name);
        assert_eq!(names, beside, "{name}");
        assert!(said.text().contains("georeferenced by"), "{name}: {}", said.text());
        let stem = &name[..1];
        assert!(folder.text(&format!("{stem}.prj")).starts_with("PROJCS[\"WGS_1984_UTM_Zone_32N\",GEOGCS["));
        if beside.iter().any(|name| name.ends_with(".json")) {
            let json = folder.json(&format!("{stem}.json"));
            assert_eq!(json["crs"], "EPSG:32632", "{name}");
            let expect = serde_json::json!([500000.0, 30.0, 0.0, 5200000.0, 0.0, -30.0]);
            assert_eq!(json["geotransform"], expect, "{name}");
        }
        if name == "c.pgm" {
            continue;
        }
        // Round trip: the coordinates and the samples.
        folder.good(&["export", name, "-o", "z.asc", "-q"]);
        let head: String = folder.text("z.asc").lines().take(5).collect::<Vec<_>>().join(" ");
        assert_eq!(head, "ncols 37 nrows 23 xllcenter 500015 yllcenter 5199325 cellsize 30", "{name}");
        assert_eq!(folder.text("z.prj"), folder.text(&format!("{stem}.prj")), "{name}");
    }
    let world = "30\n0\n0\n-30\n500015\n5199985\n";
    assert_eq!((folder.text("b.pgw").as_str(), folder.text("e.wld").as_str()), (world, world));
    folder.good(&["export", &source, "-o", "a.npy", "-q", "--no-sidecar"]);
    assert!(!folder.path("a.wld").exists());
}

#[test]
fn southern_rows_layers_and_windows_lie_where_they_are() {
    let folder = Folder::new();
    let source = corpus("f32-strips.tif");
    folder.good(&["export", &source, "-o", "a.r32", "-q", "--first-row", "south"]);
    assert_eq!(folder.text("a.wld"), "30\n0\n0\n30\n500015\n5199325\n");
    folder.good(&["export", "a.r32", "-o", "b.npy", "-q"]);
    folder.good(&["export", &source, "-o", "c.npy", "-q"]);
    assert_eq!(npy(&folder.read("b.npy")).data(), npy(&folder.read("c.npy")).data());
    folder.good(&["export", &source, "-o", "d.png", "-q", "--layer", "hillshade", "--window", "10,5,20,10"]);
    assert_eq!(folder.text("d.pgw"), "30\n0\n0\n-30\n500315\n5199835\n");
    folder.good(&["export", &source, "-o", "n.png", "-q", "--layer", "normal"]);
    assert_eq!(folder.text("n.pgw"), "30\n0\n0\n-30\n500015\n5199985\n");
    // NAME.json stores the cell size in degrees: the samples are restored exactly.
    folder.good(&["export", &corpus("degrees.tif"), "-o", "e.r32", "-q"]);
    folder.good(&["export", "e.r32", "-o", "f.npy", "-q"]);
    folder.good(&["export", &corpus("degrees.tif"), "-o", "g.npy", "-q"]);
    assert_eq!(npy(&folder.read("f.npy")).data(), npy(&folder.read("g.npy")).data());
    assert_eq!(folder.json("f.json")["crs"], "EPSG:4326");
}

#[test]
fn another_place_is_not_overwritten() {
    let folder = Folder::new();
    folder.write("a.prj", "PROJCS[\"somebody's\"]");
    let source = corpus("f32-strips.tif");
    let said = folder.run(&["export", &source, "-o", "a.asc"]);
    assert_eq!((said.code, said.out.len()), (1, 0), "{}", said.err);
    assert!(said.err.contains("filled 1 sample without height (0.12 %)"), "{}", said.err);
    assert!(said.err.contains("error: cannot write a.asc: a.prj exists and contains another position"), "{}", said.err);
    assert_eq!(folder.names(""), ["a.prj"]);
    folder.good(&["export", &source, "-o", "a.asc", "-q", "--no-sidecar"]);
    assert_eq!(folder.text("a.prj"), "PROJCS[\"somebody's\"]");
}

#[test]
fn what_is_generated_lies_on_its_map() {
    let folder = Folder::new();
    folder.good(&["generate", &corpus("placed.asc"), "-o", "out", "-q"]);
    assert_eq!(folder.text("out/map.pgw"), "30\n0\n0\n-30\n500015\n5199985\n");
    assert_eq!(folder.json("out/summary.json")["crs"], "EPSG:32632");
    folder.good(&["export", "out/height.png", "-o", "a.asc", "-q"]);
    assert!(folder.text("a.asc").contains("xllcenter 500015\nyllcenter 5199325\ncellsize 30\n"));
    assert!(folder.path("a.prj").exists());
    // A world without a position writes none.
    folder.write("small.toml", crate::harness::SMALL);
    folder.good(&["generate", "small.toml", "-o", "own", "-q"]);
    assert_eq!(folder.names("own"), ["height.png", "height8.png", "map.png", "recipe.toml", "summary.json"]);
    assert!(!folder.text("own/summary.json").contains("geotransform"));
}

#[test]
fn a_map_sheet_lies_on_its_map() {
    let folder = Folder::new();
    let source = corpus("f32-strips.tif");
    let bare = ["--no-title", "--no-axes", "--no-color", "--no-legend", "--no-scale", "--no-north"];
    folder.good(&[&["map", &source, "-o", "a.png", "-q", "--size", "740"], &bare[..]].concat());
    assert_eq!(folder.names(""), ["a.pgw", "a.png", "a.png.aux.xml", "a.prj"]);
    let numbers: Vec<f64> = folder.text("a.pgw").lines().map(|line| line.parse().unwrap()).collect();
    let [across, 0.0, 0.0, down, east, north] = numbers[..] else { panic!("{numbers:?}") };
    // The first and the last sample are at the margins, which are equally wide on both sides.
    let size = image_size(&folder.read("a.png"));
    let middle = [east + across * (size[0] - 1.0) / 2.0, north + down * (size[1] - 1.0) / 2.0];
    assert!((middle[0] - (500_015.0 + 18.0 * 30.0)).abs() < across, "{middle:?}");
    assert!((middle[1] - (5_199_985.0 - 11.0 * 30.0)).abs() < -down, "{middle:?}");
    assert!((across / -down - 1.0).abs() < 0.02 && across < 30.0, "{numbers:?}");
    folder.good(&["map", &source, "-o", "b.png", "-q", "--size", "300", "--no-sidecar"]);
    folder.good(&["map", &source, "-o", "c.svg", "-q", "--size", "300"]);
    assert_eq!(folder.names("")[4..], ["b.png", "c.svg"]);
}

/// Width and height of a PNG.
fn image_size(bytes: &[u8]) -> [f64; 2] {
    [16, 20].map(|at| f64::from(u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap())))
}

#[test]
fn bands_tiles_and_meshes() {
    let folder = Folder::new();
    folder.bad(&["export", &corpus("bands.tif"), "-o", "a.npy"], 1, "it has 3 bands");
    folder.good(&["export", &(corpus("bands.tif") + ":2"), "-o", "a.npy", "-q"]);
    assert_eq!(npy(&folder.read("a.npy"))[(1, 2)], 1032.0);
    // A recipe selects the band of the file.
    folder.good(&["generate", &(corpus("bands.tif") + ":2"), "-o", "out", "-q"]);
    assert!(folder.text("out/recipe.toml").contains("band = 2"));
    folder.good(&["export", "out/recipe.toml", "-o", "again.npy", "-q"]);
    assert!(folder.read("again.npy") == folder.read("a.npy"));
    for name in ["tiles", "tiles.vrt"] {
        let said = folder.good(&["export", &corpus(name), "-o", "t.asc"]);
        // A gap of a .vrt without a nodata value has a height of 0, as in GDAL.
        assert_eq!(said.err.contains("without height"), name == "tiles", "{}", said.err);
        assert!(folder.text("t.asc").starts_with("ncols 37\nnrows 23\nxllcenter 500015\nyllcenter 5199325\n"));
        let budget = folder.run(&["export", &corpus(name), "-o", "t.npy", "-q", "--memory", "64MiB"]);
        assert_eq!(budget.code, 0, "{}", budget.err);
    }
    folder.good(&["export", &corpus("f32-strips.tif"), "-o", "m.ply", "-q"]);
    let head = String::from_utf8_lossy(&folder.read("m.ply")[..600]).into_owned();
    assert!(head.contains("the origin on the map: east 500015, north 5199985, in EPSG:32632"), "{head}");
    folder.good(&["export", &corpus("f32-strips.tif"), "-o", "m.glb", "-q"]);
    let glb = String::from_utf8_lossy(&folder.read("m.glb")).into_owned();
    assert!(glb.contains("\"origin\":[500015.0,5199985.0]") && glb.contains("\"crs\":\"EPSG:32632\""));
}
