//! `orogen check`, `orogen graph` and `orogen cache`.

use std::io::{ErrorKind, Write};
use std::process::Stdio;
use std::time::{Duration, SystemTime};

use crate::harness::{Folder, Outcome, SMALL, png};

#[test]
fn every_fault_of_every_recipe_is_told() {
    let folder = Folder::with_small();
    let told = folder.good(&["check", "small.toml", "alpine"]).text().to_string();
    assert!(told.starts_with("small.toml: valid, 2 nodes, outputs height, noise\nalpine: valid, "), "{told}");
    folder.write(
        "bad.toml",
        "orogen = 1\n[nodes.a]\nop = \"fbm\"\nwavelenght = 5\n[nodes.b]\nop = \"fmb\"\n[outputs]\nheight = \"a\"\n",
    );
    folder.write("dem.toml", "orogen = 1\n[nodes.a]\nop = \"dem\"\npath = \"gone.tif\"\n[outputs]\nheight = \"a\"\n");
    let outcome = folder.run(&["check", "bad.toml", "small.toml", "dem.toml", "none"]);
    assert_eq!(outcome.code, 1);
    assert_eq!(outcome.text(), "small.toml: valid, 2 nodes, outputs height, noise\n");
    for expect in [
        "bad.toml:4:1: ",
        "did you mean `wavelength`?",
        "bad.toml:6:6: unknown op `fmb`",
        "gone.tif",
        "no preset or file is called `none`",
    ] {
        assert!(outcome.err.contains(expect), "{expect}: {}", outcome.err);
    }
    let outcome = folder.run(&["check", "bad.toml", "small.toml", "--json"]);
    assert_eq!((outcome.code, outcome.err.as_str()), (1, ""));
    let json: serde_json::Value = serde_json::from_slice(&outcome.out).unwrap();
    assert_eq!((json[0]["valid"].as_bool(), json[1]["valid"].as_bool()), (Some(false), Some(true)));
    assert_eq!(json[0]["errors"].as_array().unwrap().len(), 2);
    let first = &json[0]["errors"][0];
    assert_eq!([&first["line"], &first["column"], &first["length"]].map(|n| n.as_u64()), [Some(4), Some(1), Some(10)]);
    assert_eq!((json[1]["nodes"].as_u64(), &json[1]["outputs"][0]), (Some(2), &"height".into()));
    assert_eq!(folder.good(&["check", "small.toml", "-q"]).text(), "");
    folder.bad(&["check"], 2, "required");
}

/// Runs the command with data on standard input.
fn piped(folder: &Folder, arguments: &[&str], input: &[u8]) -> Outcome {
    let mut command = folder.command(arguments);
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut stdin = child.stdin.take().unwrap();
    // A command that rejects its arguments may exit before it reads any data.
    match stdin.write_all(input) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => {}
        written => written.unwrap(),
    }
    drop(stdin);
    Outcome::of(&child.wait_with_output().unwrap())
}

#[test]
fn recipes_come_from_standard_input() {
    let folder = Folder::with_small();
    folder.good(&["export", "small.toml", "-o", "a.npy", "-q"]);
    let outcome = piped(&folder, &["export", "-", "-o", "-"], SMALL.as_bytes());
    assert!(outcome.out == folder.read("a.npy"), "{}", outcome.err);
    for command in [
        &["generate", "-", "-o", "made", "-q"][..],
        &["map", "-", "-o", "m.png", "--size", "200", "-q"],
        &["explain", "-"],
        &["check", "-"],
        &["graph", "-", "-o", "g.svg"],
        // Standard input can be read only once; two seeds need it twice.
        &["export", "-", "-o", "b.npy", "--seed", "1,2"],
    ] {
        let outcome = piped(&folder, command, SMALL.as_bytes());
        assert_eq!(outcome.code, 0, "{command:?}: {}", outcome.err);
    }
    assert!(folder.path("b-1.npy").exists() && folder.path("b-2.npy").exists());
    for (input, expect) in [
        (&b"orogen = 1\nnods = 3\n"[..], "standard input:2:1: unknown key `nods`"),
        (b"", "standard input is empty"),
        (b"\xff\xfe\x00", "standard input is not a recipe"),
    ] {
        let outcome = piped(&folder, &["generate", "-", "-o", "x"], input);
        assert!(outcome.code == 1 && outcome.err.contains(expect), "{}", outcome.err);
    }
    let outcome = piped(&folder, &["generate", "-", "--watch"], SMALL.as_bytes());
    assert!(outcome.code == 2 && outcome.err.contains("not standard input"), "{}", outcome.err);
}

#[test]
fn single_files_go_to_standard_output() {
    let folder = Folder::with_solutions();
    folder.write("small.toml", SMALL);
    for (file, arguments) in [
        ("m.png", &["map", "small.toml", "--size", "200"][..]),
        ("m.svg", &["map", "small.toml", "--size", "200", "--format", "svg"]),
        ("m.pdf", &["map", "small.toml", "--size", "200", "--format", "pdf"]),
        ("r.png", &["render", "small.toml", "--size", "64x36"]),
        ("g.svg", &["graph", "small.toml"]),
        ("g.dot", &["graph", "small.toml", "--format", "dot"]),
        ("n.png", &["noise", "perlin", "--size", "32"]),
        ("v.npy", &["noise", "perlin", "--size", "8", "--volume", "3"]),
        ("f.png", &["noise", "perlin", "--size", "16", "--frames", "3"]),
        ("c.png", &["compare", "--size", "120"]),
        ("p.png", &["palettes"]),
        ("e.geojson", &["export", "small.toml", "--format", "geojson"]),
        ("e.glb", &["export", "small.toml", "--format", "glb", "--color", "none"]),
    ] {
        folder.good(&[arguments, &["-o", file]].concat());
        let streamed = folder.good(&[arguments, &["-o", "-"]].concat());
        assert!(streamed.out == folder.read(file), "{file}: {} bytes", streamed.out.len());
        assert_eq!(streamed.err, "", "{file}");
    }
    let outcome = folder.good(&["new", "-", "--preset", "hills"]);
    assert!(
        outcome.text().contains("orogen = 1") && folder.good(&["generate", "hills", "-q", "--size", "8"]).code == 0
    );
    for (arguments, expect) in [
        (&["generate", "small.toml", "-o", "-"][..], "use `orogen export`"),
        (&["build", "small.toml", "-o", "-"], "use `orogen export`"),
        (&["map", "small.toml", "-o", "a.svg", "--format", "png"], "does not match the extension"),
        (&["map", "small.toml", "-o", "a"], "a map is a .png, .svg or .pdf"),
        (&["graph", "small.toml", "-o", "a.jpg"], "a graph is a .svg, .pdf, .png, .dot or .gv"),
    ] {
        folder.bad(arguments, 2, expect);
    }
}

#[test]
fn a_graph_is_drawn_and_written_for_graphviz() {
    let folder = Folder::with_small();
    let told = folder.good(&["graph", "small.toml", "-o", "a.svg"]).text().to_string();
    assert_eq!(told, "a.svg: 2 nodes, 2 outputs, 3 wires\n");
    assert!(folder.text("a.svg").contains("<title>small"));
    folder.good(&["graph", "alpine", "-o", "a.png", "--dpi", "60"]);
    assert!(png(&folder.read("a.png")).width > 200);
    folder.good(&["graph", "alpine", "-o", "a.pdf"]);
    folder.good(&["graph", "small.toml", "-o", "a.dot"]);
    let dot = folder.text("a.dot");
    for expect in [
        "digraph \"small\" {",
        "label = \"noise\\nfbm\\nwavelength 300 m\\noctaves 4\"",
        "b0 -> b1 [headlabel = \"source\"];",
    ] {
        assert!(dot.contains(expect), "{expect}: {dot}");
    }
    // A name from a recipe cannot terminate a DOT string.
    assert_eq!(dot.matches('"').count() % 2, 0);
}

#[test]
fn the_cache_is_listed_and_cleared_and_foreign_files_stay() {
    let folder = Folder::new();
    folder.good(&["cache", "list", "--cache", "none"]);
    assert!(folder.names("").is_empty());
    folder.write("slow.toml", crate::cache::SLOW);
    for seed in ["1", "2"] {
        folder.good(&[
            "export",
            "slow.toml",
            "-q",
            "--threads",
            "1",
            "--window",
            "0,0,4,4",
            "-o",
            "a.npy",
            "--cache",
            "kept",
            "--seed",
            seed,
        ]);
    }
    let names = folder.names("kept");
    assert_eq!(names.len(), 2);
    folder.write("kept/mine.txt", "mine");
    folder.write("kept/short.solved", "mine, too");
    let told = folder.good(&["cache", "list", "--cache", "kept"]).text().to_string();
    assert!(told.contains("kept: 2 solutions, ") && told.contains("ago"), "{told}");
    let json: serde_json::Value =
        serde_json::from_slice(&folder.good(&["cache", "list", "--cache", "kept", "--json"]).out).unwrap();
    assert_eq!(json["solutions"].as_array().unwrap().len(), 2);
    assert_eq!(folder.good(&["cache", "clear", "--cache", "kept", "--older-than", "1h"]).text().lines().count(), 1);
    assert_eq!(folder.names("kept").len(), 4);
    let old = std::fs::File::options().append(true).open(folder.path("kept").join(&names[0])).unwrap();
    old.set_modified(SystemTime::now() - Duration::from_secs(7200)).unwrap();
    let told = folder.good(&["cache", "clear", "--cache", "kept", "--older-than", "1h"]).text().to_string();
    assert!(told.starts_with("kept: 1 solution removed, ") && told.contains("; 1 solution kept, "), "{told}");
    assert!(folder.path("kept").join(&names[1]).exists() && !folder.path("kept").join(&names[0]).exists());
    folder.good(&["cache", "clear", "--cache", "kept", "--keep", "1GiB", "-q"]);
    assert_eq!(folder.names("kept").len(), 3);
    let outcome = folder.command(&["cache", "clear"]).env("OROGEN_CACHE", "kept").output().unwrap();
    assert_eq!(Outcome::of(&outcome).code, 0);
    assert_eq!(folder.names("kept"), ["mine.txt", "short.solved"]);
    folder.bad(&["cache", "clear", "--older-than", "5"], 2, "an age must be a number with a unit of s, m, h, d or w");
    folder.bad(&["cache", "list"], 2, "name one with --cache");
}
