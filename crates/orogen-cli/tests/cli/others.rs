//! Short commands.

use crate::harness::{Folder, SMALL, png};
use std::process::Stdio;

#[test]
fn presets_are_one_a_line() {
    let folder = Folder::new();
    let outcome = folder.good(&["presets"]);
    let names: Vec<&str> = outcome.text().lines().map(|line| line.split_whitespace().next().unwrap()).collect();
    for name in [
        "alpine",
        "badlands",
        "canyon",
        "biomes",
        "caves",
        "continent",
        "dla-peaks",
        "endless",
        "fjords",
        "hills",
        "himalaya",
        "island",
        "rolling",
        "tile-continent",
        "tile-island",
        "volcano",
    ] {
        assert!(names.contains(&name), "{name}");
    }
    assert!(outcome.text().lines().all(|line| line.split_whitespace().count() > 3), "each says what it is");
}

#[test]
fn the_schema_is_json() {
    let folder = Folder::new();
    let schema: serde_json::Value = serde_json::from_str(folder.good(&["schema"]).text()).unwrap();
    assert!(schema["$schema"].as_str().unwrap().contains("json-schema.org"));
}

#[test]
fn a_new_recipe_is_the_preset_and_never_overwrites() {
    let folder = Folder::with_solutions();
    let outcome = folder.good(&["new", "mine", "--preset", "hills"]);
    assert!(outcome.text().contains("orogen generate mine.toml"), "{}", outcome.text());
    folder.good(&["generate", "mine.toml", "--size", "16", "-o", "a"]);
    folder.good(&["generate", "hills", "--size", "16", "-o", "b"]);
    assert_eq!(folder.text("a/recipe.toml"), folder.text("b/recipe.toml"));
    folder.write("mine.toml", "precious");
    folder.bad(&["new", "mine"], 1, "mine.toml already exists");
    assert_eq!(folder.text("mine.toml"), "precious");
    folder.good(&["new", "other.toml", "--preset", "mesa"]);
    folder.good(&["new", "v1.2"]);
    assert_eq!(folder.names(""), ["a", "b", "mine.toml", "other.toml", "v1.2.toml"]);
    // The printed command can be pasted.
    let outcome = folder.good(&["new", "it's a land"]);
    assert!(outcome.text().contains("orogen generate 'it'\\''s a land.toml'\n"), "{}", outcome.text());
    folder.bad(&["new", "x", "--preset", "messa"], 2, "did you mean `mesa`?");
    folder.bad(&["new", ".."], 2, "not a file name");
    folder.bad(&["new", "none/x"], 1, "cannot write into none");
}

#[test]
fn explain_names_nodes_locality_halo_and_memory() {
    let folder = Folder::new();
    folder.write(
        "a.toml",
        SMALL.replace("\"land\"", "\"soft\"") + "[nodes.soft]\nop = \"blur\"\nsource = \"land\"\nradius = 30\n",
    );
    let outcome = folder.good(&["explain", "a.toml"]);
    for word in ["noise", "fbm", "field", "land", "solver", "soft", "filter", "halo", "memory"] {
        assert!(outcome.text().contains(word), "{word}: {}", outcome.text());
    }
    folder.bad(&["explain", "a.toml", "--layer", "nose"], 2, "did you mean `noise`?");
}

#[test]
fn completions_for_every_shell() {
    let folder = Folder::new();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        assert!(folder.good(&["completions", shell]).text().contains("orogen"), "{shell}");
    }
    folder.bad(&["completions", "basch"], 2, "bash");
}

#[test]
fn the_layers_in_the_help_hang_below_each_other() {
    let help = Folder::new().good(&["export", "--help"]).text().to_string();
    let (_, layers) = help.split_once("Layers derived from the heights:\n").unwrap();
    let column = layers.lines().next().unwrap().find("slope in degrees").unwrap();
    assert!(layers.lines().count() > 30, "{layers}");
    for line in layers.lines() {
        assert!(line.chars().count() <= 80 && line.is_char_boundary(column), "{line}");
        let (name, about) = line.split_at(column);
        assert!(
            name.ends_with("  ") && name.starts_with("  ") && !about.starts_with(' ') && !about.is_empty(),
            "{line}"
        );
    }
}

#[test]
fn help_and_version_end_well_and_nothing_is_usage() {
    let folder = Folder::new();
    assert!(folder.good(&["--help"]).text().contains("generate"));
    assert!(folder.good(&["--version"]).text().starts_with("orogen 0."));
    assert_eq!(folder.run(&[]).code, 2);
    folder.bad(&["genrate"], 2, "generate");
}

#[test]
fn names_that_are_nothing_are_answered() {
    let folder = Folder::with_small();
    for command in [&["generate"][..], &["explain"], &["export", "-o", "a.npy"]] {
        let check = |name, code, expect: &str| folder.bad(&[command, &[name]].concat(), code, expect);
        check("alpin", 2, "did you mean `alpine`?");
        check("zzz", 2, "available presets: alpine, ");
        check("small", 2, "did you mean `small.toml`?");
        check("missing.toml", 1, "cannot read the recipe missing.toml: no such file or directory");
        check(".", 1, "it is a folder");
        check("", 2, "a value is required");
    }
}

#[test]
fn a_closed_pipe_is_quiet() {
    let folder = Folder::new();
    let mut child = folder.command(&["schema"]).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!((output.status.code(), output.stderr.len()), (Some(0), 0));
}

#[test]
fn ops_are_listed_and_told_about() {
    let folder = Folder::new();
    let list = folder.good(&["ops"]).text().to_string();
    assert!(list.lines().any(|line| line.starts_with("normalise") && line.contains("solver")), "{list}");
    let fbm = folder.good(&["ops", "fbm"]).text().to_string();
    for told in ["wavelength", "(m); default 1000.0", "whole number from 1 to 32; default 6", "\"perlin\": "] {
        assert!(fbm.contains(told), "{told} is not told in\n{fbm}");
    }
    assert!(folder.good(&["ops", "--markdown"]).text().contains("### `fbm`"));
    folder.bad(&["ops", "fbmm"], 2, "did you mean `fbm`?");
}

#[test]
fn a_simd_level_that_is_not_there_is_refused_and_the_bits_are_the_same_at_all() {
    let folder = Folder::with_small();
    let run = |level: &str, out: &str| {
        let arguments = ["generate", "small.toml", "--json", "-o", out];
        folder.command(&arguments).env("OROGEN_SIMD", level).output().unwrap()
    };
    let refused = run("avx3", "x");
    assert_eq!(refused.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("no SIMD level is called `avx3`"));
    let hash = |level: &str, out| {
        let told = String::from_utf8(run(level, out).stdout).unwrap();
        told.lines().find(|line| line.contains("sha256")).map(str::to_string).unwrap()
    };
    assert_eq!(hash("scalar", "a"), hash("", "b"));
}

#[test]
fn locate_finds_places_of_recipes_and_files_of_heights() {
    let folder = Folder::with_small();
    let found = folder.good(&["locate", "small.toml", "--largest", "height", "-q"]).text().to_string();
    assert!(found.starts_with("1. ") && found.contains(": height ") && found.contains("searched at a cell"), "{found}");
    folder.good(&["export", "small.toml", "-o", "small.tif", "-q"]);
    let of_file = folder.good(&["locate", "small.tif", "--largest", "height", "-q"]).text().to_string();
    assert_eq!(found.split(" (").next(), of_file.split(" (").next());
    // Each seed is another world.
    let seeds = folder.good(&["locate", "small.toml", "--seed", "1..3", "--largest", "height", "--json", "-q"]);
    assert_eq!(seeds.text().matches("\"places\"").count(), 3);
    folder.bad(&["locate", "small.toml", "--where", "height >"], 2, "such as `height > 3000`");
    folder.bad(&["locate", "small.toml", "--near", "1"], 2, "two numbers");
}

#[test]
fn analyze_measures_recipes_and_files_of_heights() {
    let folder = Folder::with_solutions();
    let window = ["--window", "10,20,128,96"];
    let table = folder.good(&[&["analyze", "hills"], &window[..], &["-o", "page.png"]].concat()).text().to_string();
    for told in ["128 x 96 samples of", "mean slope", "Hack's exponent", "geomorphons  flat", "page.png: the page"] {
        assert!(table.contains(told), "{told} is not told in\n{table}");
    }
    folder.good(&[&["export", "hills", "-o", "hills.tif", "-q"], &window[..]].concat());
    let json = folder.good(&["analyze", "hills.tif", "--json"]).text().to_string();
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    let recipe = folder.good(&[&["analyze", "hills", "--json"], &window[..]].concat()).text().to_string();
    let recipe: serde_json::Value = serde_json::from_str(&recipe).unwrap();
    assert_eq!(json["height_max"], recipe["height_max"]);
    assert_eq!(json["hypsometric_curve"].as_array().unwrap().len(), 101);
    assert!(json["figures"]["slope_mean"]["value"].as_f64().unwrap() > 0.1);
    folder.bad(&["analyze", "hills", "-o", "page.tif"], 2, "the extension .png");
    folder.bad(&["analyze", "hills", "--window", "0,0,20,20"], 2, "64 x 64 samples");
    assert_eq!(folder.names(""), ["hills.tif", "page.png"]);
}

#[test]
fn fit_writes_a_recipe_that_holds_nothing_of_the_place() {
    let folder = Folder::with_solutions();
    folder.good(&["export", "hills", "-o", "place.tif", "--cell", "30", "--window", "100,120,96,80", "-q"]);
    let fit = ["fit", "place.tif", "--tries", "24", "--judges", "1", "--no-cache"];
    let told = folder.good(&[&fit[..], &["-o", "like.toml"]].concat()).text().to_string();
    for said in
        ["like.toml: land like place", "windows of 80 x 80 samples of 30.0 m", "distance from the place", "mean slope"]
    {
        assert!(told.contains(said), "{said} is not told in\n{told}");
    }
    let recipe = folder.text("like.toml");
    assert!(!recipe.contains("\"dem\"") && !recipe.contains("place.tif") && recipe.len() < 6000, "{recipe}");
    // The same search gives the same result with any number of threads.
    let json = folder.good(&[&fit[..], &["-o", "again.toml", "--threads", "1", "--json"]].concat()).text().to_string();
    assert_eq!(recipe, folder.text("again.toml"));
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert!(json["recipe"]["distance"].as_f64().unwrap() > 0.0 && json["place"]["figures"]["relief"].is_number());
    // It makes terrain with approximately the given slopes.
    folder.good(&["export", "like.toml", "-o", "like.npy", "-q"]);
    folder.write("like.toml", recipe + "# mine\n");
    folder.bad(&[&fit[..], &["-o", "like.toml"]].concat(), 1, "written or edited by hand");
    folder.bad(&[&fit[..], &["-o", "like.tif"]].concat(), 2, "use the extension .toml");
    folder.good(&["export", "hills", "-o", "flat.tif", "--window", "0,0,40,40", "-q"]);
    folder.bad(&["fit", "flat.tif", "-o", "x.toml"], 2, "too small or too flat");
}

#[test]
fn a_growing_terrain_ends_as_the_recipe_says() {
    let folder = Folder::new();
    folder.write("rivers.toml", RIVERS);
    let told = folder.good(&["grow", "rivers.toml", "--frames", "5", "-o", "grow.png"]).text().to_string();
    assert_eq!(told, "grow.png: 5 frames of 60 x 40 pixels\n");
    folder.good(&["grow", "rivers.toml", "--frames", "5", "-o", "again.png", "--threads", "1", "-q"]);
    assert!(folder.read("grow.png") == folder.read("again.png"), "the same on another number of threads");
    let bytes = folder.read("grow.png");
    let mut reader = ::png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
    assert_eq!(reader.info().animation_control().unwrap().num_frames, 5);
    let mut frame = || {
        let mut data = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut data).unwrap();
        data
    };
    let frames = [frame(), frame(), frame(), frame(), frame()];
    assert!(frames.windows(2).all(|pair| pair[0] != pair[1]), "each is another");
    // One step per frame after the first; the last frame is the map of the recipe itself.
    folder.good(&["generate", "rivers.toml", "-o", "rivers", "-q"]);
    assert!(frames[4] == png(&folder.read("rivers/map.png")).data);
    folder.bad(&["grow", "hills", "-o", "x.png"], 2, "hills has no node with op");
    folder.bad(&["grow", "rivers.toml", "-o", "x.tif"], 2, "cannot be written as .tif");
    folder.bad(&["grow", "rivers.toml", "--years", "-1"], 2, "must be from 0 to 1e9");
    folder.bad(&["grow", "rivers.toml", "--frames", "1"], 2, "--frames");
}

const RIVERS: &str = r#"
orogen = 1
[world]
size = [6000, 4000]
cell = 100.0
sea_level = 0.0
[nodes.land]
op = "fbm"
wavelength = 3000
octaves = 4
[nodes.metres]
op = "remap"
source = "land"
to = [50, 400]
[nodes.terrain]
op = "stream-power"
source = "metres"
years = 400000
steps = 4
[outputs]
height = "terrain"
"#;

#[test]
fn the_studio_is_found_or_it_is_said_how_to_get_it() {
    let folder = Folder::new();
    folder.bad(&["studio", "messa"], 2, "did you mean `mesa`?");
    folder.bad(&["studio", "-"], 2, "not standard input");
}

#[test]
fn only_options_that_are_alike_are_suggested() {
    let folder = Folder::with_small();
    let export = |option: &str| folder.bad(&["export", "small.toml", "-o", "a.npy", option, "3"], 2, "").err;
    let scale = export("--scale");
    assert!(scale.starts_with("error: unexpected argument '--scale' found") && !scale.contains("cache"), "{scale}");
    assert!(export("--fomat").contains("a similar argument exists: '--format'"));
    let command = folder.bad(&["gnerate"], 2, "a similar subcommand exists: 'generate'").err;
    assert!(command.contains("unrecognized subcommand 'gnerate'"), "{command}");
    let command = folder.bad(&["treasure"], 2, "unrecognized subcommand 'treasure'").err;
    assert!(!command.contains("similar"), "{command}");
    folder.bad(&["noise", "perln"], 2, "a similar value exists: 'perlin'");
    let value = folder.bad(&["noise", "whirl"], 2, "invalid value 'whirl'").err;
    assert!(!value.contains("similar"), "{value}");
}

#[test]
fn names_do_not_control_the_terminal() {
    let folder = Folder::with_small();
    let name = "\u{1b}[31m\u{202e}a.npy";
    let outcome = folder.bad(&["export", name, "-o", "b.npy"], 1, "\\u{1b}[31m\\u{202e}a.npy");
    assert!(!outcome.err.contains('\u{1b}') && !outcome.err.contains('\u{202e}'), "{}", outcome.err);
    if cfg!(unix) {
        let told = folder.good(&["export", "small.toml", "-o", name]).text().to_string();
        assert!(told.starts_with("\\u{1b}[31m\\u{202e}a.npy: height, 64 x 48 samples"), "{told}");
    }
}

#[test]
fn numbers_of_bytes_are_refused_without_another_options_name() {
    let folder = Folder::with_small();
    for option in ["--cache-limit", "--memory"] {
        let said =
            folder.bad(&["export", "small.toml", "-o", "a.npy", option, "0"], 2, "it must be at least 1 byte").err;
        assert!(said.starts_with(&format!("error: invalid value '0' for '{option} <BYTES>': it must")), "{said}");
    }
}
