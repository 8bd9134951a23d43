//! Textures of files in recipes.

use orogen_engine::{Recipe, Result, Window, World};

/// A file of the corpus of readers; most have 37 x 23 samples.
fn corpus(name: &str) -> String {
    format!("{}/../../fuzz/corpus/dem/{name}", env!("CARGO_MANIFEST_DIR"))
}

fn recipe(file: &str, parameters: &str) -> String {
    let path = corpus(file);
    format!(
        "orogen = 1\n[nodes.texture]\nop = \"exemplar\"\npath = '{path}'\n{parameters}\n[outputs]\nheight = \"texture\"\n"
    )
}

fn open(file: &str, parameters: &str) -> Result<World> {
    World::open(Recipe::parse(&recipe(file, parameters), "t")?)
}

fn samples(file: &str, parameters: &str) -> Vec<f32> {
    let world = open(file, parameters).unwrap_or_else(|error| panic!("{error}"));
    world.window("height", &Window::new(60, 50, 10.0).at(-20, 7)).unwrap().data().to_vec()
}

#[test]
fn pictures_keep_their_values_and_heights_lose_their_trend() {
    let picture = samples("grey.png", "cell = 10");
    assert!(
        picture.iter().all(|value| (0.0..=1.0).contains(value)) && picture.iter().any(|value| *value != picture[0])
    );
    let heights = samples("f32-tiles-deflate-p3.tif", "cell = 10");
    let mean = heights.iter().sum::<f32>() / heights.len() as f32;
    let largest = heights.iter().fold(0.0f32, |largest, height| height.abs().max(largest));
    assert!(largest > 0.0 && mean.abs() < 0.5 * largest, "{mean}, {largest}");
    let halves = samples("f32-tiles-deflate-p3.tif", "cell = 10\nscale = 0.5");
    assert!(heights.iter().zip(&halves).all(|(height, half)| height * 0.5 == *half));
}

#[test]
fn every_parameter_changes_the_texture() {
    let texture = |parameters: &str| samples("f32-tiles-deflate-p3.tif", &format!("cell = 10\n{parameters}"));
    let plain = texture("");
    for parameters in ["seed = 2", "patch = 100", "wavelength = 90", "rotate = true", "scale = 2"] {
        assert!(texture(parameters) != plain, "{parameters}");
    }
    // Zeros stand for these.
    assert!(texture("patch = 115\nwavelength = 57.5") == plain);
    // A band of several.
    assert!(samples("bands.tif", "cell = 10\nband = 1") != samples("bands.tif", "cell = 10\nband = 3"));
}

#[test]
fn messages_say_what_is_wrong_with_a_file() {
    for (file, parameters, expect) in [
        ("none.tif", "", "node `texture`: "),
        ("none.png", "", "node `texture`: "),
        ("bands.tif", "", "node `texture`: "),
        ("bands.tif", "band = 9", "not a band 9"),
        ("f32-strips.tif", "patch = 5000\ncell = 100", "fit into it"),
        ("f32-strips.tif", "patch = 50\ncell = 100", "patches of 800 to 1500 m fit into it"),
    ] {
        let error = open(file, parameters).err().unwrap().to_string();
        assert!(error.contains(expect), "{file}: {error}");
    }
    let mut recipe = Recipe::parse(&recipe("f32-strips.tif", ""), "t").unwrap();
    // 4 bytes for a sample are enough for the heights only.
    let error = recipe.load(37 * 23 * 8).unwrap_err().to_string();
    assert!(error.contains("of memory, and 3.3 KiB are left"), "{error}");
    let folder = std::env::temp_dir().join(format!("orogen-exemplar-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let small = folder.join("small.asc");
    std::fs::write(&small, "ncols 20\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 10\n".to_string() + &"1 ".repeat(40))
        .unwrap();
    let text =
        format!("orogen = 1\n[nodes.a]\nop = \"exemplar\"\npath = '{}'\n[outputs]\nheight = \"a\"\n", small.display());
    let error = World::open(Recipe::parse(&text, "t").unwrap()).err().unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
    assert!(error.to_string().contains("20 x 2 samples; a texture needs at least 16 x 16"), "{error}");
    let place = error.diagnostics()[0].place.clone().unwrap();
    assert_eq!(place.line, 4, "{error}");
    let empty =
        Recipe::parse("orogen = 1\n[nodes.a]\nop = \"exemplar\"\n[outputs]\nheight = \"a\"\n", "t").unwrap_err();
    assert!(empty.to_string().contains("`path` is empty"), "{empty}");
}
