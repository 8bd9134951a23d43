//! Invalid recipes and their messages.

use orogen::{ErrorKind, Grid, Recipe, Window, World, presets};

/// Checks that the first diagnostic, as "line:column: message", is at `place` and contains every word of `words`.
fn complains(text: &str, place: &str, words: &[&str]) {
    let error = match Recipe::parse(text, "r.toml").and_then(World::open) {
        Ok(_) => panic!("this was accepted: {}", text.chars().take(300).collect::<String>()),
        Err(error) => error,
    };
    assert_eq!(error.kind(), ErrorKind::Recipe);
    let said = error.to_string();
    let first = said.lines().next().unwrap();
    // "4:8" is an exact position, "4:" any column of that line, "" any position.
    let place =
        if place.ends_with(':') || place.is_empty() { format!("r.toml:{place}") } else { format!("r.toml:{place}: ") };
    let shown: String = text.chars().take(300).collect();
    assert!(place == "r.toml:" || first.starts_with(&place), "expected {place}, not {first}\nin {shown}");
    for word in words {
        assert!(first.contains(word), "`{word}` is not said in: {first}");
    }
}

const OUT: &str = "[outputs]\nheight = \"a\"\n";

#[test]
fn wrong_recipes_are_told_where_and_what() {
    let node = |lines: &str| format!("orogen = 1\n[nodes.a]\n{lines}\n{OUT}");
    complains("", "", &["empty", "orogen = 1"]);
    complains(" \n\t\n", "", &["empty"]);
    complains("x = ", "1:5", &["not TOML"]);
    complains("[outputs]\nheight = \"a\"", "1:1", &["orogen = 1"]);
    complains("orogen = 2\n", "1:10", &["version 2", "newer"]);
    complains("orogen = \"one\"\n", "1:10", &["must be 1", "\"one\""]);
    complains("orogen = 1.0\n", "1:10", &["must be 1, not 1.0, which is not written as a whole number"]);
    complains(
        &format!("orogen = 1\n[nodes.a]\nop = \"fbm\"\noctaves = 4.0\n{OUT}"),
        "4:11",
        &["`octaves` must be a whole number from 1 to 32, not 4.0,"],
    );
    complains("orogen = 1\n", "1:1", &["no outputs"]);
    complains("orogen = 1\nwrld = 3\n", "2:1", &["unknown key `wrld`", "did you mean `world`?"]);
    complains("orogen = 1\nabout = 5\n", "2:9", &["`about`", "string"]);
    complains("orogen = 1\nworld = 3\n", "2:9", &["`world` must be a table", "3"]);
    complains(&format!("orogen = 1\n[world]\nsede = 4\n{OUT}"), "3:1", &["`sede`", "did you mean `seed`?"]);
    complains(&format!("orogen = 1\n[world]\nseed = -4\n{OUT}"), "3:8", &["`seed`", "0 to", "-4"]);
    complains(&format!("orogen = 1\n[world]\nsize = 0\n{OUT}"), "3:8", &["`size`", "0.001"]);
    complains(&format!("orogen = 1\n[world]\nsize = [5, -1]\n{OUT}"), "3:12", &["`size`", "-1"]);
    complains(&format!("orogen = 1\n[world]\ncell = nan\n{OUT}"), "3:8", &["`cell`", "a number from 0.0001", "nan"]);
    complains(&format!("orogen = 1\n[world]\ncell = inf\n{OUT}"), "3:8", &["`cell`", "a number from 0.0001", "inf"]);
    complains(
        &format!("orogen = 1\n[world]\nsize = 1e9\ncell = 0.001\n[nodes.a]\nop = \"fbm\"\n{OUT}"),
        "2:2",
        &["samples along a side", "Raise `cell`"],
    );
    complains(&format!("orogen = 1\n[world]\nsize = 5\ncell = 10\n[nodes.a]\nop = \"fbm\"\n{OUT}"), "2:2", &["`cell`"]);
    complains(&format!("orogen = 1\nnodes = 1\n{OUT}"), "2:9", &["`nodes` must be a table"]);
    complains(&format!("orogen = 1\n[nodes]\na = 1\n{OUT}"), "3:5", &["node `a` must be a table"]);
    complains(&node("seed = 1"), "2:8", &["no `op`"]);
    complains(&node("op = 5"), "3:6", &["`op` must be"]);
    complains(&node("op = \"fbn\""), "3:6", &["unknown op `fbn`", "did you mean `fbm`?"]);
    complains(&node("op = \"quux\""), "3:6", &["unknown op `quux`", "`fbm`", "`normalise`"]);
    complains(&node("op = \"fbm\"\noctavs = 3"), "4:1", &["`octavs`", "did you mean `octaves`?"]);
    complains(
        &node("op = \"fbm\"\nfrequency = 0.5"),
        "4:1",
        &["`frequency`", "write `wavelength`, which is 1 / frequency"],
    );
    complains(&node("op = \"fbm\"\npersistence = 2"), "4:15", &["`gain`", "0 to 1"]);
    complains(&node("op = \"fbm\"\ngain = 0.5\npersistence = 0.5"), "5:1", &["`gain`", "twice"]);
    complains(&node("op = \"fbm\"\noctaves = 2.5"), "4:11", &["whole number from 1 to", "2.5"]);
    complains(&node("op = \"fbm\"\noctaves = 0"), "4:11", &["from 1", "not 0"]);
    complains(&node("op = \"fbm\"\nwavelength = \"far\""), "4:14", &["finite number", "\"far\"", "(m)"]);
    complains(&node("op = \"fbm\"\ngain = nan"), "4:8", &["finite", "nan"]);
    complains(&node("op = \"fbm\"\nbasis = \"perln\""), "4:9", &["one of", "did you mean \"perlin\"?"]);
    complains(&node("op = \"blur\""), "2:8", &["`source`", "missing"]);
    complains(&node("op = \"blur\"\nsource = \"b\""), "4:10", &["unknown node `b`", "`a`"]);
    complains(&node("op = \"blur\"\nsource = nan"), "4:10", &["finite number"]);
    complains(&node("op = \"blur\"\nsource = 1e300"), "4:10", &["not a valid sample value"]);
    complains(&node("op = \"blur\"\nsource = [1]"), "4:10", &["must name a node"]);
    complains(&node("op = \"blur\"\nsource = \"a\""), "4:10", &["reads itself"]);
    complains(&node("op = \"blur\"\nsource = 1\nmask = \"a\""), "5:8", &["reads itself"]);
    complains(&node("op = \"blur\"\nsource = \"a.flow\""), "4:10", &["no layer `flow`", "`height`"]);
    complains(&node("op = \"clamp\"\nsource = 1\nlow = 3\nhigh = 1"), "5:7", &["`low` (3)", "`high` (1)"]);
    complains(&node("op = \"remap\"\nsource = 1\nfrom = [1, 1]"), "5:8", &["must differ"]);
    complains(&node("op = \"curve\"\nsource = 1\npoints = [[0, 0], [0, 1]]"), "5:10", &["greater than"]);
    complains(&node("op = \"curve\"\nsource = 1\npoints = [[0, 0]]"), "5:10", &["at least two"]);
    complains(&node("op = \"normalise\"\nsource = 1"), "2:8", &["unbounded", "`size`"]);
    complains(&node("op = \"edge\""), "2:8", &["unbounded", "`size`"]);
    complains(
        "orogen = 1\n[nodes.\"a b\"]\nop = \"fbm\"\n[outputs]\nheight = 1\n",
        "2:8",
        &["cannot be a node's name"],
    );
    complains("orogen = 1\n[nodes.a]\nop = \"fbm\"\n[nodes.a]\nop = \"fbm\"\n", "4:", &["not TOML", "duplicate"]);
    complains("orogen = 1\n[nodes.a]\nop = \"fbm\"\n[outputs]\n", "4:1", &["`outputs` is empty"]);
    complains("orogen = 1\n[nodes.a]\nop = \"fbm\"\n[outputs]\nheight = \"b\"\n", "5:10", &["unknown node `b`", "`a`"]);
    let cycle = "orogen = 1\n[nodes.a]\nop = \"blur\"\nsource = \"c\"\n[nodes.b]\nop = \"blur\"\nsource = \"a\"\n\
                 [nodes.c]\nop = \"blur\"\nsource = \"b\"\n[outputs]\nheight = \"a\"\n";
    complains(cycle, "", &["cycle", "a", "b", "c"]);
}

#[test]
fn wrong_json_is_told_too() {
    complains("{", "1:", &["not JSON"]);
    complains("{}", "1:1", &["orogen = 1"]);
    complains("{\"orogen\": 1, \"orogen\": 1}", "1:15", &["appears twice"]);
    complains(
        "{\"orogen\": 1, \"nodes\": {\"a\": {\"op\": \"fbm\"}, \"a\": {\"op\": \"fbm\"}}}",
        "1:45",
        &["two nodes are named `a`"],
    );
    complains("{\"orogen\": 1, \"nodes\": {\"a\": null}}", "1:30", &["must be a table", "null"]);
    complains("{\"orogen\": 1, // a comment\n\"outputs\": {}}", "1:", &["not JSON"]);
    for text in ["// a comment\n{\"orogen\": 1}", "null"] {
        let error = Recipe::parse(text, "r.json").unwrap_err().to_string();
        assert!(error.starts_with("r.json:1:") && !error.contains("TOML"), "{error}");
    }
    let deep = format!("{{\"orogen\": {}", "[".repeat(1_000_000));
    complains(&deep, "1:", &["nested more than"]);
}

#[test]
fn depth_and_size_have_bounds() {
    complains(&format!("orogen = 1\nx = {}", "[".repeat(1_000_000)), "2:", &["not TOML"]);
    complains(&format!("orogen = 1\n{}", "[a.".repeat(300_000)), "2:", &["not TOML"]);
    complains(&"x".repeat(17 << 20), "", &["longer than 16 MiB"]);
    let mut many = String::from("{\"orogen\": 1, \"nodes\": {");
    for i in 0..1_000_000 {
        many.push_str(&format!("\"n{i}\":1,"));
    }
    many.push_str("\"z\": 1}}");
    complains(&many, "1:", &["1000001 nodes", "65536"]);
    let mut keys = String::from("orogen = 1\n[nodes.a]\nop = \"fbm\"\n");
    for i in 0..200_000 {
        keys.push_str(&format!("k{i}=1\n"));
    }
    complains(&keys, "4:1", &["unknown key `k0`"]);
    let mut missing = String::from("orogen = 1\n");
    for i in 0..60_000 {
        missing.push_str(&format!("[nodes.n{i}]\nop=\"blur\"\nsource=\"m{i}\"\n"));
    }
    missing.push_str("[outputs]\nheight = 1\n");
    complains(&missing, "4:8", &["unknown node `m0`"]);
}

#[test]
fn all_complaints_come_at_once() {
    let text = format!("orogen = 1\n[world]\nsede = 1\n[nodes.a]\nop = \"fbm\"\noctavs = 3\ngain = 7\n{OUT}");
    let error = Recipe::parse(&text, "r.toml").unwrap_err();
    let places: Vec<usize> = error.diagnostics().iter().map(|c| c.place.as_ref().unwrap().line).collect();
    assert_eq!(places, [3, 6, 7], "{error}");
    let place = error.diagnostics()[1].place.as_ref().unwrap();
    assert_eq!((place.column, place.length, place.text.as_str()), (1, 6, "octavs = 3"));
}

#[test]
fn columns_count_characters_not_bytes() {
    let text =
        "orogen = 1\nabout = \"Höhenzüge — 山\"\n[nodes.a]\nop = \"fbm\" # Größe\n[outputs]\nheight = { \"ü\" = 1 }\n";
    let error = Recipe::parse(text, "r").unwrap_err();
    assert_eq!(error.diagnostics()[0].place.as_ref().unwrap().column, 10, "{error}");
}

#[test]
fn json_has_one_kind_of_number_and_texts_may_have_a_mark_of_the_byte_order() {
    let json = "{\"orogen\":1e0,\"world\":{\"seed\":7.0},\"nodes\":{\"a\":{\"op\":\"fbm\",\"octaves\":4.0}},\"outputs\":{\"height\":\"a\"}}";
    let toml = format!("orogen = 1\n[world]\nseed = 7\n[nodes.a]\nop = \"fbm\"\noctaves = 4\n{OUT}");
    let expect = Recipe::parse(&toml, "r").unwrap();
    for text in [json, &format!("\u{feff}{json}"), &format!("\u{feff}{toml}")] {
        assert_eq!(Recipe::parse(text, "r").unwrap(), expect, "{text}");
    }
    // The byte order mark does not count as a column.
    complains("\u{feff}{\"orogen\":1.5}", "1:11", &["must be 1, not 1.5"]);
    complains("\u{feff}orogen = 3", "1:10", &["version 3"]);
}

#[test]
fn json_and_toml_mean_the_same() {
    let toml = "orogen = 1\nabout = \"two\"\n[world]\nseed = 3\nsize = 500\ncell = 5\n[nodes.a]\nop = \"fbm\"\noctaves = 2\n\
                [nodes.b]\nop = \"normalise\"\nsource = \"a\"\nmask = 0.5\n[outputs]\nheight = \"b\"\n";
    let json = r#"{"$schema": "x", "orogen": 1, "about": "two", "world": {"seed": 3, "size": [500, 500.0], "cell": 5},
        "nodes": {"a": {"op": "fbm", "octaves": 2}, "b": {"op": "normalise", "source": "a", "mask": 0.5}},
        "outputs": {"height": "b"}}"#;
    assert_eq!(Recipe::parse(toml, "t").unwrap(), Recipe::parse(json, "j").unwrap());
}

#[test]
fn what_is_written_reads_back() {
    for preset in presets::all() {
        let recipe = preset.recipe().unwrap_or_else(|error| panic!("{error}"));
        let text = recipe.to_toml();
        assert_eq!(recipe, Recipe::parse(&text, "again").unwrap_or_else(|error| panic!("{error}\n{text}")));
        assert!(!recipe.about.is_empty() && recipe.about.chars().count() <= 80, "{}: {}", preset.name, recipe.about);
        assert!(preset.text.starts_with("#:schema orogen.schema.json"), "{} names its schema", preset.name);
        assert!(recipe.outputs().any(|layer| layer == "height"));
    }
    assert!(presets::find(presets::DEFAULT).is_some());
}

/// Recipes damaged at random (cut, flipped and doubled bytes) yield a recipe or messages, never a panic.
#[test]
fn broken_texts_never_panic() {
    break_texts(4_000);
}

#[test]
#[ignore = "long: 200 000 broken texts"]
fn many_broken_texts_never_panic() {
    break_texts(200_000);
}

fn break_texts(rounds: usize) {
    let mut seed = 0x9E37_79B9_7F4A_7C15u64;
    let mut random = move |n: usize| {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        (seed % n.max(1) as u64) as usize
    };
    let json = r#"{"orogen": 1, "world": {"size": [100, 100]}, "nodes": {"a": {"op": "curve", "source": 0.5,
        "points": [[0, 0], [1, 1]]}}, "outputs": {"height": "a"}}"#;
    let texts: Vec<&str> = presets::all().iter().map(|preset| preset.text).chain([json]).collect();
    for _ in 0..rounds {
        let mut bytes = texts[random(texts.len())].as_bytes().to_vec();
        for _ in 0..=random(4) {
            let at = random(bytes.len());
            match random(6) {
                0 => bytes.truncate(at),
                1 => bytes[at] = b"[]{}\"'=.,#\\\n\0-e9"[random(16)],
                2 => bytes.insert(at, b"[]{}\"'=.,#\\\n\0-e9"[random(16)]),
                3 => {
                    bytes.remove(at);
                }
                4 => {
                    let end = (at + random(40)).min(bytes.len());
                    let part = bytes[at..end].to_vec();
                    bytes.splice(at..at, part);
                }
                _ => {
                    let end = (at + random(40)).min(bytes.len());
                    bytes.drain(at..end);
                }
            }
            if bytes.is_empty() {
                break;
            }
        }
        if let Ok(text) = String::from_utf8(bytes)
            && let Ok(recipe) = Recipe::parse(&text, "fuzz")
        {
            let written = recipe.to_toml();
            assert!(Recipe::parse(&written, "again").is_ok_and(|again| again == recipe), "{text}\n{written}");
        }
    }
}

#[test]
fn recipes_in_the_docs_are_recipes() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut found = 0;
    for page in ["README.md", "docs/recipes.md"] {
        let text = std::fs::read_to_string(root.join(page)).unwrap();
        for block in text.split("```toml\n").skip(1) {
            let block = block.split("```").next().unwrap();
            if block.contains("orogen = 1") {
                let world = Recipe::parse(block, page).and_then(World::open).unwrap_or_else(|error| panic!("{error}"));
                world.window("height", &Window::new(16, 16, 60.0)).unwrap_or_else(|error| panic!("{error}"));
                found += 1;
            }
        }
    }
    assert_eq!(found, 6);
}

/// Counts teeth and notches of a cliff: samples more than 40 m above, or below, the ground on both sides; and steps of
/// more than 40 m.
fn teeth(grid: &Grid) -> (usize, usize, f32) {
    let (width, height) = (grid.width() as i64, grid.height() as i64);
    let (mut teeth, mut steps, mut most) = (0, 0, 0.0f32);
    for j in 2..height - 2 {
        for i in 2..width - 2 {
            let at = |x: i64, y: i64| grid[(x as usize, y as usize)];
            let here = at(i, j);
            for [x, y] in [[1, 0], [0, 1]] {
                let step = (at(i + x, j + y) - here).abs();
                (steps, most) = (steps + usize::from(step > 40.0), most.max(step));
                let [a, b] = [here - at(i - x, j - y), here - at(i + x, j + y)];
                teeth += usize::from(a.min(b) > 40.0 || a.max(b) < -40.0);
            }
        }
    }
    (teeth, steps, most)
}

#[test]
fn cliffs_of_the_preset_mesa_have_no_teeth() {
    for seed in [4, 1] {
        let mut recipe = presets::find("mesa").unwrap().recipe().unwrap();
        recipe.world.seed = seed;
        let world = World::open(recipe).unwrap();
        let grid = world.window("height", &Window::new(700, 700, 20.0).at(150, 150)).unwrap();
        let (teeth, steps, most) = teeth(&grid);
        assert!(steps > 5000, "{seed}: no cliffs, {steps}");
        assert!((teeth as f64) < 0.002 * steps as f64, "{seed}: {teeth} of {steps}");
        // A stratum of 90 m, and slopes above and below it.
        assert!(most < 200.0, "{seed}: {most} m from one sample to the next");
    }
}

#[test]
fn former_keys_mean_what_todays_mean() {
    let recipe = |keys: [&str; 4]| {
        let [erodibility, uplift, jitter, random] = keys;
        format!(
            "orogen = 1\n[world]\nsize = [2000, 2000]\ncell = 50\n[nodes.land]\nop = \"fbm\"\n[nodes.worn]\nop = \"stream-power\"\n\
             source = \"land\"\nsteps = 1\n{erodibility} = 0.5\n{uplift} = \"land\"\n{jitter} = 0.25\n{random} = false\n\
             [outputs]\nheight = \"worn\"\n"
        )
    };
    let today = recipe(["erodibility_factor", "uplift_factor", "jitter", "random_receivers"]);
    let former = recipe(["softness", "rise", "irregular", "scatter"]);
    let [today, former] = [&today, &former].map(|text| Recipe::parse(text, "test.toml").unwrap());
    assert_eq!(today, former);
    assert!(former.to_toml().contains("jitter = 0.25"), "{}", former.to_toml());
    complains(&recipe_with_both(), "5:1", &["jitter", "twice"]);
}

fn recipe_with_both() -> String {
    "orogen = 1\n[nodes.worn]\nop = \"stream-power\"\njitter = 0.5\nirregular = 0.5\nsource = 1\n".to_string()
}
