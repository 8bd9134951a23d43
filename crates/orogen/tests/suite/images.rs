//! Pictures as masks.

use orogen::io::format::levels::Levels;
use orogen::io::format::png;
use orogen::io::test_folder::TestFolder;
use orogen::{Grid, Recipe, Window, World};
use std::path::Path;

/// A picture with the values 0, 1/19, 2/19 ... 1, row by row.
fn greys() -> Grid {
    Grid::from_data(Window::new(5, 4, 1.0), (0..20).map(|k| k as f32).collect()).unwrap()
}

fn opened(folder: &Path, more: &str) -> orogen::Result<World> {
    let text = format!(
        "orogen = 1\n[nodes.mask]\nop = \"image\"\npath = \"mask.png\"\n{more}\n[outputs]\nheight = \"mask\"\n"
    );
    let mut recipe = Recipe::parse(&text, "r.toml")?;
    recipe.set_base_dir(folder);
    World::open(recipe)
}

#[test]
fn pixels_stand_where_they_are_laid() {
    let folder = TestFolder::new("images-laid").unwrap();
    let grid = greys();
    for bits in [8, 16] {
        let mut bytes = Vec::new();
        let levels = Levels::of(&grid);
        match bits {
            8 => png::write_grey8(&mut bytes, &grid, &levels, &[]).unwrap(),
            _ => png::write_grey16(&mut bytes, &grid, &levels, &[]).unwrap(),
        }
        std::fs::write(folder.join("mask.png"), &bytes).unwrap();
        // 25 m from pixel to pixel, with the first pixel at (100, -50).
        let world = opened(&folder, "at = [100, -50]\nwidth = 100\noutside = 0.25").unwrap();
        for j in 0..4 {
            for i in 0..5 {
                let got = world.height(100.0 + 25.0 * i as f64, -50.0 + 25.0 * j as f64).unwrap();
                let expect = grid[(i, j)] / 19.0;
                assert!((got - expect).abs() < 0.6 / 255.0, "{bits}: ({i}, {j}) is {got}, not {expect}");
            }
        }
        for (x, y) in [(99.0, 0.0), (201.0, 0.0), (150.0, -51.0), (150.0, 26.0)] {
            assert_eq!(world.height(x, y).unwrap(), 0.25, "({x}, {y})");
        }
        let between = world.height(112.5, -50.0).unwrap();
        assert!(between > 0.0 && between < 1.0 / 19.0, "{between}");
    }
}

#[test]
fn what_is_no_picture_is_named() {
    let folder = TestFolder::new("images-named").unwrap();
    let said = |why: &str| {
        let error = opened(&folder, "").err().unwrap().to_string();
        assert!(error.contains(why) && error.contains("mask"), "{error}");
    };
    said("mask.png");
    std::fs::write(folder.join("mask.png"), b"GIF89a no picture of ours").unwrap();
    said("not a valid PNG");
    let text = "orogen = 1\n[nodes.mask]\nop = \"image\"\npath = \"mask.tif\"\n[outputs]\nheight = \"mask\"\n";
    let error = Recipe::parse(text, "r.toml").and_then(World::open).err().unwrap().to_string();
    assert!(error.contains("only reads .png"), "{error}");
    let text = "orogen = 1\n[nodes.mask]\nop = \"image\"\n[outputs]\nheight = \"mask\"\n";
    let error = Recipe::parse(text, "r.toml").and_then(World::open).err().unwrap().to_string();
    assert!(error.contains("`path` is empty"), "{error}");
}
