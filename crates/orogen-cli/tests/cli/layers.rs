//! Layers of `orogen export` that are derived from the heights.

use crate::harness::{Folder, SMALL, npy, png};
use orogen::export::derived::layer::Nature;
use orogen::export::derived::list as derived;

#[test]
fn layers_that_follow_from_the_heights() {
    let folder = Folder::with_small();
    for (layer, low, high) in [
        ("slope", 0.0, 90.0),
        ("aspect", 0.0, 360.0),
        ("curvature", -1.0, 1.0),
        ("occlusion", 0.0, 1.0),
        ("normal", -1.0, 1.0),
    ] {
        folder.good(&["export", "small.toml", "-o", "a.png", "--layer", layer, "-q"]);
        folder.good(&["export", "small.toml", "-o", "a.exr", "--layer", layer, "-q"]);
        let picture = png(&folder.read("a.png"));
        assert_eq!(picture.channels, if layer == "normal" { 3 } else { 1 }, "{layer}");
        if layer != "normal" {
            folder.good(&["export", "small.toml", "-o", "a.npy", "--layer", layer, "-q"]);
            assert!(npy(&folder.read("a.npy")).data().iter().all(|sample| (low..=high).contains(sample)), "{layer}");
        }
    }
    // Only green is inverted for DirectX.
    folder.good(&["export", "small.toml", "-o", "b.png", "--layer", "normal", "--normal", "directx", "-q"]);
    folder.good(&["export", "small.toml", "-o", "a.png", "--layer", "normal", "-q"]);
    let (up, down) = (png(&folder.read("a.png")).data, png(&folder.read("b.png")).data);
    for (up, down) in up.chunks_exact(3).zip(down.chunks_exact(3)) {
        assert!(up[0] == down[0] && up[2] == down[2] && (i32::from(up[1]) + i32::from(down[1]) - 255).abs() <= 1);
    }
    folder.bad(&["export", "small.toml", "-o", "c.png", "--layer", "slop"], 2, "did you mean `slope`");
    folder.bad(&["export", "small.toml", "-o", "c.tif", "--layer", "normal"], 2, "formats for it: exr, npy, png");
    folder.bad(
        &["export", "small.toml", "-o", "c.png", "--normal", "opengl"],
        2,
        "--normal applies to the layer `normal`",
    );
    folder.bad(&["export", "small.toml", "-o", "-", "--format", "png", "--layer", "splat"], 2, "name a file with -o");
}

#[test]
fn weights_add_up_to_255_over_all_pictures() {
    let folder = Folder::with_small();
    folder.good(&["export", "small.toml", "-o", "a.png", "--layer", "splat", "-q"]);
    folder.good(&["export", "small.toml", "-o", "b.png", "--layer", "splat", "--weights", "layers", "-q"]);
    let names = ["grass", "sand", "scree", "rock", "snow", "bed"];
    let (first, second) = (png(&folder.read("a.png")).data, png(&folder.read("a_2.png")).data);
    let layers: Vec<Vec<u8>> = names.iter().map(|name| png(&folder.read(&format!("b_{name}.png"))).data).collect();
    for (k, (first, second)) in first.chunks_exact(4).zip(second.chunks_exact(4)).enumerate() {
        let weights: Vec<u8> = layers.iter().map(|layer| layer[k]).collect();
        assert_eq!(weights.iter().map(|weight| u32::from(*weight)).sum::<u32>(), 255);
        assert_eq!([first, second].concat(), [&weights[..], &[0, 0]].concat());
    }
    let most = |name: &str| layers[names.iter().position(|other| *other == name).unwrap()].iter().max();
    assert!(["grass", "rock", "sand"].iter().all(|name| most(name) > Some(&200)), "steep ground by the sea");
    assert!(!folder.path("b.png").exists() && folder.json("b.json")["files"][5]["channels"][0] == "bed");
}

#[test]
fn contours_are_lines_of_the_heights_asked_for() {
    let folder = Folder::with_small();
    let told = folder.good(&["export", "small.toml", "-o", "a.geojson", "--interval", "50"]);
    assert!(told.text().contains(" contour lines of 5 heights, one each 50 m"), "{}", told.text());
    let lines = |name: &str| folder.json(name)["features"].as_array().unwrap().clone();
    let (all, heights) = (lines("a.geojson"), npy_heights(&folder));
    let levels: std::collections::BTreeSet<i64> =
        all.iter().map(|line| line["properties"]["elevation"].as_i64().unwrap()).collect();
    assert_eq!(levels.into_iter().collect::<Vec<i64>>(), [0, 50, 100, 150, 200]);
    // A point on an edge between two samples has the interpolated height.
    for line in &all {
        for point in line["geometry"]["coordinates"].as_array().unwrap() {
            let at = |k: usize| point[k].as_f64().unwrap() / 10.0;
            let (x, y) = (at(0), -at(1));
            let (i, j) = (x.floor() as usize, y.floor() as usize);
            let (next_i, next_j) = (x.ceil() as usize, y.ceil() as usize);
            let share = (x - x.floor()) + (y - y.floor());
            let (from, to) = (heights[(i, j)], heights[(next_i, next_j)]);
            let between = f64::from(from) + f64::from(to - from) * share;
            let told = line["properties"]["elevation"].as_f64().unwrap();
            assert!((between - told).abs() < 0.05, "{x} {y}: {between}, {told}");
        }
    }
    folder.good(&["export", "small.toml", "-o", "b.geojson", "--levels", "-10,100", "--smooth", "2", "-q"]);
    let smooth = lines("b.geojson");
    assert!(smooth.iter().any(|line| line["properties"]["elevation"] == -10));
    folder.good(&["export", "small.toml", "-o", "a.svg", "-q"]);
    assert!(folder.text("a.svg").starts_with("<svg xmlns=") && folder.text("a.svg").contains("id=\"h100\""));
    for (given, expect) in [
        (["--interval", "0"], "invalid value '0' for '--interval <M>'"),
        (["--levels", "1,two"], "`two` in --levels is not a height"),
        (["--smooth", "9"], "a whole number from 0 to 6"),
    ] {
        folder.bad(&[&["export", "small.toml", "-o", "c.geojson"][..], &given].concat(), 2, expect);
    }
    folder.bad(
        &["export", "small.toml", "-o", "c.npy", "--interval", "5"],
        2,
        "it applies to: .fgb, .geojson, .gpkg and .svg",
    );
    assert!(!folder.path("c.geojson").exists());
}

fn npy_heights(folder: &Folder) -> orogen::Grid {
    folder.good(&["export", "small.toml", "-o", "heights.npy", "-q"]);
    npy(&folder.read("heights.npy"))
}

#[test]
fn layers_that_follow_from_the_heights_have_options_of_their_own() {
    let folder = Folder::with_small();
    folder.good(&["export", "small.toml", "-o", "heights.tif", "-q"]);
    let export = |layer: &str, options: &[&str]| {
        let mut arguments = vec!["export", "heights.tif", "-o", "layer.npy", "-q", "--layer", layer];
        arguments.extend(options);
        folder.good(&arguments);
        npy(&folder.read("layer.npy"))
    };
    // Every layer is made, with its required options.
    let numbers = derived::all().iter().filter(|layer| layer.nature() == Nature::Numbers);
    for name in numbers.map(|layer| layer.name) {
        let needed: &[&str] = if name == "viewshed" { &["--observer", "300,200"] } else { &[] };
        let made = export(name, needed);
        assert_eq!((made.width(), made.height()), (64, 48), "{name}");
    }
    // Options change the result.
    let (june, winter) = (export("insolation", &["--day", "172"]), export("insolation", &["--season", "winter"]));
    assert!(june.data().iter().zip(winter.data()).all(|(june, winter)| june > winter));
    // A single day uses a smaller time step than the node's default.
    let node = "[nodes.sun]\nop = \"insolation\"\nsource = \"land\"\ndays = [172, 172]\nstep = 0.1\n[outputs]\nsun = \"sun\"\n";
    folder.write("sun.toml", SMALL.replace("[outputs]\n", node));
    folder.good(&["export", "sun.toml", "-o", "node.npy", "-q", "--layer", "sun"]);
    folder.good(&["export", "small.toml", "-o", "layer.npy", "-q", "--layer", "insolation", "--day", "172"]);
    assert_eq!(npy(&folder.read("node.npy")).data(), npy(&folder.read("layer.npy")).data());
    let south = export("insolation", &["--season", "winter", "--latitude", "-45"]);
    // Not everywhere: a steep north slope receives more of a low northern sun than of a high southern one.
    assert!(south.data().iter().sum::<f32>() < june.data().iter().sum::<f32>());
    let few = export("height-above-drainage", &["--stream", "1e9"]);
    let many = export("height-above-drainage", &["--stream", "500"]);
    assert!(few.data().iter().sum::<f32>() > 2.0 * many.data().iter().sum::<f32>());
    let (low, high) = (
        export("viewshed", &["--observer", "300,200"]),
        export("viewshed", &["--observer", "300,200", "--observer-height", "5000"]),
    );
    assert!(low.data().iter().sum::<f32>() < high.data().iter().sum::<f32>());
    let codes = export("flow-direction", &["--codes", "grass"]);
    assert!(codes.data().iter().all(|code| (0.0..=8.0).contains(code)) && codes.data().contains(&7.0));
}

#[test]
fn what_a_layer_cannot_do_is_a_sentence() {
    let folder = Folder::with_small();
    let endless = "orogen = 1\n[nodes.a]\nop = \"fbm\"\n[outputs]\nheight = \"a\"\n";
    folder.write("endless.toml", endless);
    for (recipe, options, expect) in [
        (
            "small.toml",
            &["--layer", "slope", "--day", "5"][..],
            "--day does not apply to the layer slope; it applies to: insolation",
        ),
        ("small.toml", &["--day", "5"], "--day does not apply to the layer height"),
        ("small.toml", &["--layer", "viewshed"], "the layer viewshed needs --observer X,Y"),
        ("small.toml", &["--layer", "viewshed", "--observer", "9e9,0"], "is outside the world"),
        ("small.toml", &["--layer", "insolation", "--day", "366"], "a whole number from 1 to 365"),
        (
            "small.toml",
            &["--layer", "insolation", "--day", "5", "--season", "winter"],
            "--day and --season exclude each other",
        ),
        ("endless.toml", &["--layer", "wetness"], "the layer wetness needs a bounded world"),
    ] {
        let mut arguments = vec!["export", recipe, "-o", "x.npy"];
        arguments.extend(options);
        folder.bad(&arguments, 2, expect);
    }
    assert!(!folder.path("x.npy").exists());
    // Layers that need no bounds work without them.
    folder.good(&["export", "endless.toml", "-o", "x.npy", "--layer", "landforms", "--window", "0,0,9,9", "-q"]);
}

#[test]
fn the_light_of_a_hillshade_is_chosen() {
    let folder = Folder::new();
    // A plane that rises at 45 degrees to the east.
    let row = (0..6).map(|column| (10 * column).to_string()).collect::<Vec<_>>().join(" ");
    let rows = vec![row; 6].join("\n");
    folder.write("plane.asc", format!("ncols 6\nnrows 6\nxllcorner 0\nyllcorner 100\ncellsize 10\n{rows}\n"));
    let middle = |args: &[&str]| {
        folder.good(&[&["export", "plane.asc", "-o", "x.npy", "--force", "--layer", "hillshade"], args].concat());
        npy(&folder.read("x.npy"))[(3, 3)]
    };
    let half = 0.5f32.sqrt();
    for (args, expect) in [
        // Light from the north-west at 45 degrees: half of it comes from the side.
        (&[][..], half * half * half + half * half),
        (&["--azimuth", "270"], 1.0),
        (&["--azimuth", "-90", "--altitude", "45"], 1.0),
        (&["--azimuth", "90"], 0.0),
        (&["--altitude", "90"], half),
        (&["--azimuth", "0", "--altitude", "30"], 0.5 * half),
        (&["--z-factor", "0", "--altitude", "30"], 0.5),
        (&["--azimuth", "270", "--altitude", "0", "--z-factor", "2"], (4.0f32 / 5.0).sqrt()),
    ] {
        let found = middle(args);
        assert!((found - expect).abs() < 1e-6, "{args:?}: {found}, not {expect}");
    }
    // Pictures for engines have the same light.
    let engine = |args: &[&str]| {
        let line = [
            "export",
            "plane.asc",
            "-o",
            "e.png",
            "--force",
            "--layer",
            "hillshade",
            "--target",
            "unity",
            "--size",
            "33",
        ];
        folder.good(&[&line, args].concat());
        folder.read("e.png")
    };
    assert!(engine(&[]) != engine(&["--azimuth", "20"]));
    for (args, expect) in [
        (["hillshade", "--altitude", "91"], "it must be a number from 0 to 90"),
        (["slope", "--azimuth", "20"], "--azimuth does not apply to the layer slope; it applies to: hillshade"),
    ] {
        folder.bad(&[&["export", "plane.asc", "-o", "y.npy", "--layer"][..], &args].concat(), 2, expect);
    }
}
