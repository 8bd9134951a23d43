//! Scattered objects: `--layer scatter` and `--objects`.

use crate::harness::{Folder, SMALL};

const SCATTER: &str = r#"
[[scatter]]
name = "house"
spacing = 60
turn = 90
[[scatter]]
name = "tree"
spacing = 8
size = [0.5, 1.5]
height = { min = 20 }
clearance = 20
"#;

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("land.toml", SMALL.to_string() + SCATTER);
    folder
}

/// A line of a table: x, y, z, kind, size, turn.
type Line = (f64, f64, f64, String, f64, f64);

/// The lines of a table.
fn lines(folder: &Folder, name: &str) -> Vec<Line> {
    let text = folder.text(name);
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("x,y,z,kind,size,turn,height"));
    let line = |line: &str| {
        let values: Vec<&str> = line.split(',').collect();
        let number = |k: usize| values[k].parse().unwrap();
        assert_eq!(values[2], values[6]);
        (number(0), number(1), number(2), values[3].to_string(), number(4), number(5))
    };
    lines.map(line).collect()
}

#[test]
fn objects_are_points_in_every_format_of_features() {
    let folder = folder();
    let said = folder.good(&["export", "land.toml", "-o", "all.csv", "--layer", "scatter"]).text().to_string();
    let all = lines(&folder, "all.csv");
    assert!(said.contains(&format!("{} features of scatter", all.len())), "{said}");
    assert!(all.len() > 500 && all.iter().all(|(x, y, ..)| (0.0..640.0).contains(x) && (-480.0..=0.0).contains(y)));
    for (_, _, z, kind, size, turn) in &all {
        match kind.as_str() {
            "house" => assert!(*size == 1.0 && *turn == 90.0 && *z > 0.0),
            _ => assert!(kind == "tree" && (0.5..=1.5).contains(size) && *z > 0.0, "{kind} {size} {z}"),
        }
    }
    // The same bytes again on one thread, and every object exactly once in adjacent windows.
    folder.good(&["export", "land.toml", "-o", "again.csv", "--layer", "scatter", "--threads", "1", "-q"]);
    assert_eq!(folder.text("all.csv"), folder.text("again.csv"));
    let mut parts = Vec::new();
    for (name, window) in [("west.csv", "0,0,31,48"), ("east.csv", "31,0,33,48")] {
        folder.good(&["export", "land.toml", "-o", name, "--layer", "scatter", "--window", window, "-q"]);
        parts.extend(lines(&folder, name));
    }
    let sorted = |mut lines: Vec<Line>| {
        lines.sort_by(|a, b| a.partial_cmp(b).unwrap());
        lines
    };
    assert_eq!(sorted(parts), sorted(all.clone()));
    folder.good(&["export", "land.toml", "-o", "all.geojson", "--layer", "scatter", "-q"]);
    let features = folder.json("all.geojson");
    assert_eq!(features["features"].as_array().unwrap().len(), all.len());
    assert_eq!(features["features"][0]["properties"]["kind"], "house");
    for name in ["all.gpkg", "all.fgb", "all.svg"] {
        folder.good(&["export", "land.toml", "-o", name, "--layer", "scatter", "-q"]);
    }
    // With other layers of features in one file.
    folder.good(&["export", "land.toml", "-o", "more.gpkg", "--layer", "scatter,coast", "-q"]);
}

#[test]
fn meshes_carry_objects_that_stand_on_them() {
    let folder = folder();
    let said = folder
        .good(&["export", "land.toml", "-o", "land.glb", "--objects", "--window", "3,5,40,30"])
        .text()
        .to_string();
    folder.good(&["export", "land.toml", "-o", "all.tres", "--layer", "scatter", "--window", "3,5,40,30", "-q"]);
    let bytes = folder.read("land.glb");
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    let json: serde_json::Value = serde_json::from_slice(&bytes[20..20 + word(12)]).unwrap();
    let binary = 20 + word(12) + 8;
    assert_eq!(json["extensionsUsed"], serde_json::json!(["EXT_mesh_gpu_instancing"]));
    assert_eq!(json["scenes"][0]["nodes"], serde_json::json!([0, 1, 2]));
    assert_eq!(json["buffers"][0]["byteLength"], bytes.len() - binary);
    for (node, kind) in [(1, "house"), (2, "tree")] {
        let node = &json["nodes"][node];
        assert_eq!((&node["name"], &node["translation"]), (&kind.into(), &serde_json::json!([30.0, 0.0, 50.0])));
        let attributes = &node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
        let numbers = |name: &str, parts: usize| {
            let accessor = &json["accessors"][attributes[name].as_u64().unwrap() as usize];
            let view = &json["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
            let start = binary + view["byteOffset"].as_u64().unwrap() as usize;
            let count = accessor["count"].as_u64().unwrap() as usize;
            assert_eq!(view["byteLength"], count * parts * 4);
            let number = |k: usize| f32::from_bits(word(start + 4 * k) as u32);
            (0..count).map(|k| (0..parts).map(|part| number(k * parts + part)).collect()).collect::<Vec<Vec<f32>>>()
        };
        let (places, turns, sizes) = (numbers("TRANSLATION", 3), numbers("ROTATION", 4), numbers("SCALE", 3));
        assert!(places.len() > 5 && said.contains(&format!("{} objects of {kind}", places.len())), "{said}");
        assert!(places.iter().all(|at| (0.0..=390.0).contains(&at[0]) && (0.0..=290.0).contains(&at[2])));
        assert!(turns.iter().all(|q| (q.iter().map(|part| part * part).sum::<f32>() - 1.0).abs() < 1e-5));
        // The transforms for Godot are the same.
        let text = folder.text(&format!("all_{kind}.tres"));
        assert!(text.starts_with("[gd_resource type=\"MultiMesh\" format=3]\n"));
        assert!(text.contains(&format!("instance_count = {}\n", places.len())));
        let list = text.split_once("PackedFloat32Array(").unwrap().1.trim_end().trim_end_matches(')');
        let transforms: Vec<f32> = list.split(", ").map(|number| number.parse().unwrap()).collect();
        for ((transform, place), size) in transforms.chunks_exact(12).zip(&places).zip(&sizes) {
            assert_eq!([transform[3], transform[7], transform[11]], place[..]);
            assert_eq!(transform[5], size[1]);
        }
        assert_eq!(transforms.len(), 12 * places.len());
    }
    // Exaggerated heights apply to both.
    folder.good(&["export", "land.toml", "-o", "steep.glb", "--objects", "--exaggeration", "2", "-q"]);
}

#[test]
fn samples_are_lines_of_a_table() {
    let folder = folder();
    folder.good(&["export", "land.toml", "-o", "a.csv", "--window", "2,3,4,2"]);
    let text = folder.text("a.csv");
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!((lines.len(), lines[0]), (9, "x,y,height"));
    assert!(lines[1].starts_with("20,-30,") && lines[8].starts_with("50,-40,"), "{text}");
}

#[test]
fn what_cannot_be_is_refused() {
    let folder = folder();
    folder.write("bare.toml", SMALL);
    for (args, expect) in [
        (&["bare.toml", "-o", "x.csv", "--layer", "scatter"][..], "add a table `[[scatter]]`"),
        (&["bare.toml", "-o", "x.glb", "--objects"], "add a table `[[scatter]]`"),
        (&["land.toml", "-o", "x.tif", "--layer", "scatter"], "consists of vector features, which .tif cannot hold"),
        (&["land.toml", "-o", "x.glb", "--layer", "noise", "--objects"], "--objects applies to the layer `height`"),
        (&["land.toml", "-o", "x.tres"], "a .tres file holds objects: use --layer scatter"),
        (&["land.toml", "-o", "x.tres", "--layer", "scatter", "--window", "0,0,1,9"], "is empty"),
        (&["land.toml", "-o", "-", "--format", "tres", "--layer", "scatter"], "not to standard output"),
        (&["land.toml", "-o", "x.csv", "--layer", "coast"], "holds points"),
        (&["land.toml", "-o", "x.csv", "--prominence", "3"], "it applies to summits"),
        (&["land.toml", "-o", "x.obj", "--objects"], "--objects does not apply to the format obj; it applies to: .glb"),
    ] {
        let outcome = folder.run(&[&["export"], args].concat());
        assert!(outcome.code != 0 && outcome.err.contains(expect), "{args:?}: {}", outcome.err);
        assert_eq!(folder.names("").len(), 2, "{args:?}");
    }
}

/// The trees of a Unity file as the lines of a table, for a terrain with this length and this south-west corner; and
/// the lowest and the highest height.
fn trees(folder: &Folder, name: &str, length: f64, corner: [f64; 2]) -> (Vec<Line>, [f64; 2]) {
    let file = folder.json(name);
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    let (low, size) = (number(&file["low"]), &file["size"]);
    assert_eq!([number(&size["x"]), number(&size["z"])], [length; 2]);
    let rise = number(&size["y"]);
    let tree = |tree: &serde_json::Value| {
        let [x, y, z] = ["x", "y", "z"].map(|axis| number(&tree["position"][axis]));
        assert!([x, y, z].iter().all(|share| (0.0..=1.0).contains(share)), "{tree}");
        assert_eq!(tree["widthScale"], tree["heightScale"]);
        let kind = file["prototypes"][tree["prototypeIndex"].as_u64().unwrap() as usize].as_str().unwrap();
        let turn = number(&tree["rotation"]).to_degrees();
        (
            corner[0] + x * length,
            corner[1] + z * length,
            low + y * rise,
            kind.to_string(),
            number(&tree["widthScale"]),
            turn,
        )
    };
    (file["trees"].as_array().unwrap().iter().map(tree).collect(), [low, low + rise])
}

#[test]
fn unity_gets_trees_that_stand_on_its_terrain() {
    let folder = folder();
    let export = |args: &str| folder.good(&args.split(' ').collect::<Vec<_>>()).text().to_string();
    let alike = |found: &[Line], expect: &[Line]| {
        assert_eq!(found.len(), expect.len());
        for (a, b) in found.iter().zip(expect) {
            let off = [a.0 - b.0, a.1 - b.1, a.2 - b.2, (a.4 - b.4) * 10.0, (a.5 - b.5) * 0.1];
            assert!(a.3 == b.3 && off.iter().all(|off| off.abs() < 1e-3), "{a:?} {b:?}");
        }
    };
    // The table includes objects up to one cell beyond the last samples.
    let within = |name: &str| {
        let mut all = lines(&folder, name);
        all.retain(|(x, y, ..)| *x < 480.0 && *y > -480.0);
        all
    };
    export("export land.toml -o u.r16 --target unity --size 33 -q");
    let said = export("export land.toml -o trees.json --target unity --size 33 --layer scatter");
    export("export land.toml -o same.csv --layer scatter --window 0,0,33,33 --cell 15 -q");
    let (found, [low, high]) = trees(&folder, "trees.json", 480.0, [0.0, -480.0]);
    assert!(
        found.len() > 300 && found.iter().any(|tree| tree.3 == "house") && found.iter().any(|tree| tree.3 == "tree")
    );
    alike(&found, &within("same.csv"));
    let houses = found.iter().filter(|tree| tree.3 == "house").count();
    assert!(said.contains(&format!("{houses} objects of house (prototype 0), ")), "{said}");
    assert!(said.contains("TerrainData.treePrototypes"), "{said}");
    // Heights match the terrain's levels around a tree within half a step.
    let about = folder.json("u.json");
    assert!(
        (about["low"].as_f64().unwrap() - low).abs() < 1e-4 && (about["high"].as_f64().unwrap() - high).abs() < 1e-4
    );
    let levels: Vec<f64> =
        folder.read("u.r16").chunks_exact(2).map(|pair| f64::from(u16::from_le_bytes([pair[0], pair[1]]))).collect();
    for (x, y, z, ..) in &found {
        let [column, row] = [x / 15.0, (y + 480.0) / 15.0].map(|at| (at as usize).min(31));
        let corners = [0, 1, 33, 34].map(|step| levels[33 * row + column + step]);
        let level = (z - low) / (high - low) * 65535.0;
        let [least, greatest] =
            [corners.iter().copied().fold(65535.0, f64::min), corners.iter().copied().fold(0.0, f64::max)];
        assert!((least - 0.6..=greatest + 0.6).contains(&level), "{level} {corners:?}");
    }
    // Tiles have one scale and contain each object once.
    export("export land.toml -o t.r16 --target unity --size 33 --cell 7.5 --tiles 2x2 -q");
    export("export land.toml -o t_trees.json --target unity --size 33 --cell 7.5 --tiles 2x2 --layer scatter -q");
    export("export land.toml -o fine.csv --layer scatter --window 0,0,65,65 --cell 7.5 -q");
    let mut all = Vec::new();
    for (tile, corner) in
        [("0_0", [0.0, -480.0]), ("1_0", [240.0, -480.0]), ("0_1", [0.0, -240.0]), ("1_1", [240.0, -240.0])]
    {
        let (part, range) = trees(&folder, &format!("t_trees_{tile}.json"), 240.0, corner);
        let about = folder.json(&format!("t_{tile}.json"));
        assert!(["low", "high"].iter().zip(range).all(|(key, end)| (about[*key].as_f64().unwrap() - end).abs() < 1e-4));
        assert!(part.len() > 50);
        all.extend(part);
    }
    let expect = within("fine.csv");
    assert_eq!(all.len(), expect.len());
    for one in &expect {
        let same = all.iter().filter(|tree| (tree.0 - one.0).abs() + (tree.1 - one.1).abs() < 2e-3).collect::<Vec<_>>();
        assert_eq!(same.len(), 1, "{one:?}");
        alike(&[same[0].clone()], std::slice::from_ref(one));
    }
    // Without an engine, the terrain is the window. Objects for Godot are on the same terrain.
    export("export land.toml -o plain.json --layer scatter --window 0,0,33,33 --cell 15 -q");
    assert_eq!(folder.text("plain.json"), folder.text("trees.json"));
    export("export land.toml -o g.tres --target hterrain --size 65 --layer scatter -q");
    export("export land.toml -o h.tres --layer scatter --window 0,0,65,65 --cell 7.5 -q");
    assert_eq!(folder.text("g_tree.tres"), folder.text("h_tree.tres"));
    for (args, expect) in [
        (
            "-o u.json --target unity --size 33 --layer scatter",
            "u.json describes u.r16; name another file, such as u_trees.json",
        ),
        ("-o x.csv --target unity --layer scatter", "unity reads `scatter` as .json, not as .csv"),
        ("-o x.png --target unity --layer scatter", "unity reads `scatter` as .json, not as .png"),
        ("-o x.json --target unity --layer coast", "unity has no form of its own for `coast`; leave out --target"),
        (
            "-o x.json --target unreal --layer scatter",
            "unreal has no form of its own for `scatter`; leave out --target",
        ),
        ("-o x.json", "a .json file holds objects: use --layer scatter"),
    ] {
        let line = format!("export land.toml {args}");
        folder.bad(&line.split(' ').collect::<Vec<_>>(), 2, expect);
    }
}
