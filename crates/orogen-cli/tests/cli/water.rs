//! `orogen export` of vector features, and `--water`.

use crate::harness::Folder;

#[test]
fn water_goes_into_formats_of_features() {
    let folder = Folder::new();
    let line = |args: &[&'static str]| [&["export", "fjords", "--seed", "3", "--cell", "240"], args].concat();
    let said = |args: &[&'static str]| folder.good(&line(args)).text().to_string();
    let all = "rivers,lakes,watersheds,summits,coast,contours";
    let told = said(&["-o", "w.gpkg", "--layer", all]);
    assert!(told.contains("features of rivers") && told.contains("features of contours"), "{told}");
    let bytes = folder.read("w.gpkg");
    assert!(bytes.starts_with(b"SQLite format 3\0") && &bytes[68..72] == b"GPKG" && bytes.len().is_multiple_of(4096));
    said(&["-o", "again.gpkg", "--layer", all, "--threads", "1"]);
    assert!(bytes == folder.read("again.gpkg"));
    said(&["-o", "w.fgb", "--layer", "rivers"]);
    assert!(folder.read("w.fgb").starts_with(b"fgb\x03fgb"));
    said(&["-o", "w.geojson", "--layer", "lakes"]);
    assert_eq!(folder.json("w.geojson")["features"][0]["geometry"]["type"], "MultiPolygon");
    said(&["-o", "w.svg", "--layer", "rivers,lakes"]);
    assert!(folder.text("w.svg").contains("<g id=\"rivers\""));
    // Contours of any raster layer can be written to the vector formats.
    said(&["-o", "c.gpkg", "--layer", "slope"]);
}

#[test]
fn meshes_carry_water() {
    let folder = Folder::new();
    let line = |args: &[&'static str]| [&["export", "fjords", "--seed", "3", "--cell", "240"], args].concat();
    let plain = folder.good(&line(&["-o", "plain.glb"])).text().to_string();
    let wet = folder.good(&line(&["-o", "wet.glb", "--water", "--max-error", "10"])).text().to_string();
    assert!(!plain.contains("sea") && wet.contains("rivers, lakes, sea"), "{wet}");
    let bytes = folder.read("wet.glb");
    let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    let json: serde_json::Value = serde_json::from_slice(&bytes[20..20 + length]).unwrap();
    assert_eq!(json["scenes"][0]["nodes"], serde_json::json!([0, 1, 2, 3]));
    let materials: Vec<&str> =
        json["materials"].as_array().unwrap().iter().map(|material| material["name"].as_str().unwrap()).collect();
    assert_eq!(materials, ["terrain", "rivers", "lakes", "sea"]);
    assert_eq!(json["materials"][1]["alphaMode"], "BLEND");
    let sea =
        &json["accessors"][json["meshes"][3]["primitives"][0]["attributes"]["POSITION"].as_u64().unwrap() as usize];
    assert_eq!((&sea["min"][1], &sea["max"][1]), (&serde_json::json!(0.0), &serde_json::json!(0.0)));
}

#[test]
fn what_cannot_be_is_refused() {
    let folder = Folder::new();
    for (args, expect) in [
        (&["-o", "x.tif", "--layer", "rivers"][..], "consists of vector features, which .tif cannot hold"),
        (&["-o", "x.tif", "--layer", "rivers,lakes"], "formats that can: .csv, .fgb, .geojson, .gpkg, .svg, .tres"),
        (&["-o", "x.fgb", "--layer", "rivers,lakes"], "holds one layer"),
        (&["-o", "x.gpkg", "--layer", "rivers,puddles"], "rivers,puddles"),
        (
            &["-o", "x.gpkg", "--layer", "rivers", "--interval", "20"],
            "--interval has no effect here; it applies to contours",
        ),
        (&["-o", "x.gpkg", "--layer", "summits", "--runoff", "2"], "it applies to lakes, rivers, watersheds"),
        (&["-o", "x.tif", "--river-area", "2"], "does not apply to the format tif"),
        (&["-o", "x.glb", "--layer", "slope", "--water"], "--water applies to the layer `height`"),
        (&["-o", "x.gpkg", "--layer", "rivers", "--memory", "1MiB"], "memory"),
    ] {
        let outcome = folder.run(&[&["export", "archipelago", "--cell", "160"], args].concat());
        assert!(outcome.code != 0 && outcome.err.contains(expect), "{args:?}: {}", outcome.err);
        assert!(folder.names("").is_empty(), "{args:?}");
    }
}
