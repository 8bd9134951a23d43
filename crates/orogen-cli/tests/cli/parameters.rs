//! `--set`, for every command that takes a recipe.

use crate::commands::{WRITERS, prepare, workplace};
use crate::harness::{Folder, png};

const RECIPE: &str = r#"
orogen = 1
[parameters.relief]
default = 100
unit = "m"
range = [1, 1000]
help = "Height of the hills"
[world]
size = [600, 400]
cell = 5
[nodes.noise]
op = "fbm"
wavelength = 200
[nodes.land]
op = "expr"
expr = "noise * relief"
[outputs]
height = "land"
"#;

#[test]
fn every_command_that_takes_a_recipe_takes_values_for_it() {
    let folder = workplace();
    let with_recipe = |arguments: &[&str]| ["small.toml", "rivers.toml", "hills"].contains(&arguments[1]);
    let mut tried = 0;
    let writers = WRITERS.iter().filter(|writer| with_recipe(writer.arguments));
    let talkers = [&["explain", "small.toml"][..], &["check", "small.toml"]];
    for writer in writers.clone() {
        prepare(&folder, writer);
    }
    for arguments in writers.map(|writer| writer.arguments).chain(talkers) {
        let arguments: Vec<&str> = arguments.iter().copied().chain(["--set", "no_such=1"]).collect();
        folder.bad(&arguments, 1, "there is no parameter `no_such`");
        tried += 1;
    }
    assert!(tried > 20, "{tried}");
}

#[test]
fn variants_on_one_sheet() {
    let folder = Folder::new();
    folder.write("a.toml", RECIPE);
    let size = |name: &str| {
        let bytes = std::fs::read(folder.path(name)).unwrap();
        [16, 20].map(|at| u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap()))
    };
    folder.good(&["variants", "a.toml", "--seeds", "4", "--size", "96", "-o", "seeds.png", "-q"]);
    folder.good(&["variants", "a.toml", "--sweep", "relief=100..900:6", "--size", "96", "-o", "sweep.png", "-q"]);
    // Two by two, and three by two tiles of 96 x 64 samples.
    assert_eq!((size("seeds.png")[0], size("sweep.png")[0]), (88 + 2 * 96 + 20, 88 + 3 * 96 + 2 * 20));
    assert_eq!(size("seeds.png")[1], size("sweep.png")[1]);
    folder.good(&["variants", "a.toml", "--seeds", "4", "--size", "96", "-o", "again.png", "-q", "--threads", "1"]);
    assert_eq!(std::fs::read(folder.path("seeds.png")).unwrap(), std::fs::read(folder.path("again.png")).unwrap());
    // The same values as a list. The palette covers the heights of all pictures, in maps and in renders.
    let draw = |more: &[&str]| {
        folder.good(&[&["variants", "a.toml", "--size", "96", "-o", "x.png", "--force", "-q"], more].concat());
        png(&folder.read("x.png"))
    };
    let evenly = draw(&["--sweep", "relief=100..900:3"]);
    let listed = draw(&["--sweep", "relief=100,500,900"]);
    let above_footer = 3 * evenly.width * (evenly.height - 60);
    assert_eq!(evenly.data[..above_footer], listed.data[..above_footer]);
    folder.write("two.toml", "unit = \"range\"\nstops = [[0, [1.0, 0, 0]], [1, [0, 0, 1.0]]]\n");
    let palette = ["--sweep", "relief=2,900", "--palette", "two.toml", "--nearest-color"];
    let colored = |picture: &crate::harness::Picture| {
        let is = |pixel: &&[u8], c: usize| i32::from(pixel[c]) > 60 + i32::from(pixel[2 - c]);
        [0, 2].map(|c| picture.data.chunks(3).filter(|pixel| is(pixel, c)).count())
    };
    for more in [&[][..], &["--render"], &["--render", "--camera", "120,40"]] {
        let [red, blue] = colored(&draw(&[&palette[..], more].concat()));
        // Low land fills the first picture, and part of the second.
        assert!(red > blue && blue > 200, "{more:?}: {red} red, {blue} blue");
    }
    assert_ne!(
        draw(&["--seeds", "1", "--render"]).data,
        draw(&["--seeds", "1", "--render", "--camera", "120,40"]).data
    );
    folder.bad(&["variants", "a.toml", "--camera", "1,2"], 2, "--render");
    folder.bad(&["variants", "a.toml", "--render", "--camera", "1,-2"], 2, "above the horizon");
    folder.bad(&["variants", "a.toml", "--sweep", "relief=1,x"], 2, "with 2 to 64 values, such as relief=200,500,2000");
    folder.bad(&["variants", "a.toml", "--sweep", "relif=100..900:6"], 1, "did you mean `relief`?");
    folder.bad(&["variants", "a.toml", "--sweep", "relief=100..9000:6"], 1, "from 1 to 1000");
    folder.bad(&["variants", "a.toml", "--sweep", "relief=100"], 2, "relief=200..2000:9");
    folder.bad(&["variants", "a.toml", "--seeds", "4", "--sweep", "relief=1..9:3"], 2, "cannot be used with");
    folder.bad(&["variants", "a.toml", "-o", "a.tif"], 2, "the sheet is written as PNG");
}

#[test]
fn variants_as_an_animation() {
    let folder = Folder::new();
    folder.write("a.toml", RECIPE);
    let draw = |more: &[&str]| {
        folder.good(
            &[&["variants", "a.toml", "--size", "96", "-q", "--animate", "--sweep", "relief=100,500,900"], more]
                .concat(),
        );
    };
    // Forward and back: 100, 500, 900, 500.
    draw(&["-o", "frame-%d.png"]);
    let frames: Vec<Vec<u8>> = (0..4).map(|k| png(&folder.read(&format!("frame-{k}.png"))).data).collect();
    assert!(frames[1] == frames[3] && frames[0] != frames[1] && frames[1] != frames[2] && frames[0] != frames[2]);
    assert!(!folder.path("frame-4.png").exists());
    // The same pixels in one file, with the duration of its frames (`acTL` contains their number).
    draw(&["-o", "moving.png", "--delay", "70"]);
    let moving = folder.read("moving.png");
    assert_eq!(png(&moving).data, frames[0]);
    let chunk = moving.windows(4).position(|name| name == b"acTL").unwrap();
    assert_eq!(moving[chunk + 4..chunk + 8], 4u32.to_be_bytes());
    draw(&["-o", "moving.gif"]);
    assert!(folder.read("moving.gif").starts_with(b"GIF89a"));
    draw(&["-o", "view-%d.png", "--render"]);
    let [low, high] = [0, 2].map(|k| png(&folder.read(&format!("view-{k}.png"))));
    assert!(low.data != high.data && (low.width, low.height) == (96, 72));
    let bad =
        |more: &[&str], expect: &str| folder.bad(&[&["variants", "a.toml", "--animate"], more].concat(), 2, expect);
    bad(&["-o", "x.png"], "--sweep");
    bad(&["--sweep", "relief=1,2", "-o", "x.tif"], "an animated .png");
    bad(&["--sweep", "relief=1,2", "--columns", "2"], "cannot be used with");
    folder.write("wide.toml", RECIPE.replace("[600,", "[\"= 10 * relief\","));
    folder.bad(
        &["variants", "wide.toml", "--animate", "--sweep", "relief=100,900", "--size", "96", "-o", "x.png"],
        2,
        "frames of an animation are of one size",
    );
    assert!(!folder.path("x.png").exists());
}

#[test]
fn values_change_what_is_made() {
    let folder = Folder::new();
    folder.write("a.toml", RECIPE);
    let low = folder.good(&["analyze", "a.toml", "--json"]).text().to_string();
    let high = folder.good(&["analyze", "a.toml", "--json", "--set", "relief=500"]).text().to_string();
    assert_ne!(low, high);
    folder.good(&["generate", "a.toml", "-o", "made", "--set", "relief=500", "-q"]);
    let written = std::fs::read_to_string(folder.path("made/recipe.toml")).unwrap();
    assert!(written.contains("[parameters.relief]\ndefault = 500.0\n"), "{written}");
    let again = folder.good(&["analyze", "made/recipe.toml", "--json"]).text().to_string();
    let measures =
        |text: &str| text.lines().filter(|line| !line.contains("toml")).map(str::to_string).collect::<Vec<_>>();
    assert_eq!(measures(&again), measures(&high));
    let explained = folder.good(&["explain", "a.toml"]).text().to_string();
    assert!(explained.contains("relief  100 m  1 to 1000         Height of the hills"), "{explained}");
    folder.bad(
        &["explain", "a.toml", "--set", "relief=5000"],
        1,
        "`relief` must be a finite number from 1 to 1000 (m), not 5000",
    );
    folder.bad(&["explain", "a.toml", "--set", "relief"], 2, "as a name and a number");
    folder.bad(&["explain", "a.toml", "--set", "relief=high"], 2, "must be a number");
}
