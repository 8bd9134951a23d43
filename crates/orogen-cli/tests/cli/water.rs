//! `orogen export` of vector features, and `--water`.

use crate::harness::Folder;

#[test]
fn water_goes_into_formats_of_features() {
    let folder = Folder::with_solutions();
    let line = |args: &[&'static str]| [&["export", "fjords", "--seed", "3", "--cell", "240"], args].concat();
    let said = |args: &[&'static str]| folder.good(&line(args)).text().to_string();
    let all = "rivers,lakes,watersheds,summits,coast,contours";
    let told = said(&["-o", "w.gpkg", "--layer", all]);
    assert!(told.contains("features of rivers") && told.contains("features of contours"), "{told}");
    let bytes = folder.read("w.gpkg");
    assert!(bytes.starts_with(b"SQLite format 3\0") && &bytes[68..72] == b"GPKG" && bytes.len().is_multiple_of(4096));
    said(&["-o", "again.gpkg", "--layer", all, "--threads", "1", "--no-cache"]);
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
    let folder = Folder::with_solutions();
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
        (
            &["-o", "x.tif", "--layer", "rivers,lakes"],
            "formats that can: .csv, .fgb, .geojson, .gpkg, .json, .svg, .tres",
        ),
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

/// A valley of 40 x 30 samples of 10 m: its sides fall to column 20, whose bed falls to the south.
fn valley(folder: &Folder, name: &str) {
    let mut text = "ncols 40\nnrows 30\nxllcorner 1000\nyllcorner 2000\ncellsize 10\n".to_string();
    for row in 0..30 {
        let line: Vec<String> =
            (0..40i32).map(|column| (100 + (column - 20).abs() * 5 + 29 - row).to_string()).collect();
        text.push_str(&line.join(" "));
        text.push('\n');
    }
    folder.write(name, text);
}

#[test]
fn watersheds_of_chosen_outlets() {
    let folder = Folder::new();
    valley(&folder, "valley.asc");
    let export = |out: &'static str, args: &[&'static str]| {
        folder.good(&[&["export", "valley.asc", "-o", out, "--layer", "watershed"], args].concat());
    };
    // The center of column 20 and row 20: 21 rows drain through it.
    export("one.geojson", &["--outlet", "1205,2095", "--snap", "0", "--smooth", "0"]);
    let feature = folder.json("one.geojson")["features"][0].clone();
    let expect = serde_json::json!({
        "id": 1, "name": null, "area": 84000, "drainage_area": 84000, "outlet_x": 1205, "outlet_y": 2095, "moved": 0,
        "downstream": null, "at_border": true, "lowest": 109, "highest": 229, "mean": 169
    });
    for (name, value) in expect.as_object().unwrap() {
        let found = &feature["properties"][name];
        assert!(found == value || found.as_f64() == value.as_f64() && value.is_number(), "{name}: {found}");
    }
    let ring = serde_json::json!([[[[1000, 2300], [1000, 2090], [1400, 2090], [1400, 2300], [1000, 2300]]]]);
    assert_eq!(feature["geometry"]["coordinates"], ring);
    // Points from files are moved to the stream; the upper watershed is a part of the lower one.
    folder.write("gauges.csv", "Name;X;Y\nLower \"old\";1245;2055\nUpper;1180,5;2.195e3\n");
    folder.write(
        "gauges.geojson",
        r#"{"type":"FeatureCollection","features":[
            {"type":"Feature","properties":{"name":"Lower \"old\""},"geometry":{"type":"Point","coordinates":[1245,2055]}},
            {"type":"Feature","properties":{"name":"Upper"},"geometry":{"type":"Point","coordinates":[1180.5,2195]}}]}"#,
    );
    for (file, out) in [("gauges.csv", "a.geojson"), ("gauges.geojson", "b.geojson")] {
        export(out, &["--outlets", file, "--river-area", "20000"]);
        let features = folder.json(out)["features"].clone();
        for (k, name, area, moved, downstream) in
            [(0, "Lower \"old\"", 100_000.0, 40.0, None), (1, "Upper", 44_000.0, 24.5, Some(1))]
        {
            let properties = &features[k]["properties"];
            assert_eq!(properties["name"], name);
            let far = |name: &str, expect: f64| (properties[name].as_f64().unwrap() - expect).abs();
            assert!(far("area", area) < 1e-6 && far("moved", moved) < 1e-6, "{properties}");
            assert_eq!(properties["downstream"].as_i64(), downstream);
        }
    }
    assert_eq!(folder.read("a.geojson"), folder.read("b.geojson"));
    export("all.gpkg", &["--outlets", "gauges.csv", "--river-area", "20000"]);
    export("all.svg", &["--outlets", "gauges.csv", "--river-area", "20000"]);
    assert_eq!(folder.text("all.svg").matches("<path").count(), 2);
}

#[test]
fn outlets_that_have_no_watershed_are_refused() {
    let folder = Folder::new();
    valley(&folder, "valley.asc");
    folder.write("two.csv", "x,y,name\n1205,2095,Mill\n1205,1995,Ford\n");
    folder.write("names.csv", "place,height\nMill,3\n");
    let files = folder.names("");
    for (args, expect) in [
        (&[][..], "the layer watershed needs --outlet E,N or --outlets FILE"),
        (
            &["--outlet", "5,5"],
            "the outlet at 5,5 is outside the window, which extends from 1000 to 1400 east and from 2000 to 2300 north",
        ),
        (&["--outlets", "two.csv", "--river-area", "20000"], "the outlet `Ford` at 1205,1995 is outside the window"),
        (&["--outlets", "names.csv"], "line 1 must name the columns with the coordinates"),
        (&["--outlets", "no.csv"], "no.csv"),
        (&["--outlets", "two.csv", "--outlet", "1205,2095"], "exclude each other"),
        (
            &["--outlet", "1305,2095", "--river-area", "20000"],
            "has no stream within 50 m that drains at least 20000 m^2; the nearest is 100 m away (--snap 100)",
        ),
        (
            &["--outlet", "1305,2095", "--river-area", "1e9"],
            "there is none in the window (--river-area sets the minimum)",
        ),
    ] {
        let outcome =
            folder.run(&[&["export", "valley.asc", "-o", "x.geojson", "--layer", "watershed"], args].concat());
        assert!(outcome.code != 0 && outcome.err.contains(expect), "{args:?}: {}", outcome.err);
    }
    for (args, expect) in [
        (
            &["valley.asc", "-o", "x.tif", "--layer", "watershed", "--outlet", "1205,2095"][..],
            "--outlet does not apply to the format tif",
        ),
        (&["valley.asc", "-o", "x.geojson", "--layer", "rivers", "--outlet", "1205,2095"], "it applies to watershed"),
        (
            &["archipelago", "--cell", "160", "-o", "x.geojson", "--layer", "watershed", "--outlet", "1,-1"],
            "the outlet at 1,-1 is in the sea, and",
        ),
        (
            &[
                "archipelago",
                "--cell",
                "160",
                "-o",
                "x.geojson",
                "--layer",
                "watershed",
                "--outlet",
                "1,-1",
                "--snap",
                "0",
            ],
            "the outlet at 1,-1 is in the sea; give a place on land",
        ),
        (
            &["valley.asc", "--crs", "EPSG:32632", "-o", "x.geojson", "--layer", "watershed", "--outlet", "9,47"],
            "in EPSG:32632; longitude and latitude must be converted to this CRS first",
        ),
    ] {
        let outcome = folder.run(&[&["export"], args].concat());
        assert!(outcome.code != 0 && outcome.err.contains(expect), "{args:?}: {}", outcome.err);
    }
    // A file of outlets is not replaced by output that is made from it.
    folder.write("out.geojson", r#"{"type":"Point","coordinates":[1205,2095]}"#);
    let line =
        ["export", "valley.asc", "-o", "out.geojson", "--force", "--layer", "watershed", "--outlets", "out.geojson"];
    assert!(folder.run(&line).code != 0 && folder.text("out.geojson").contains("\"Point\""));
    assert_eq!(folder.names("").len(), files.len() + 1);
}
