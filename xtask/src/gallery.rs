//! `cargo xtask gallery`: makes the pictures of the README and the docs with `orogen` itself.

use crate::failure::{Failure, Result, on_file};
use crate::{book, clients, codegen, shell};

mod base64;
mod blocks;
mod levels;
mod noises;
mod presets;
mod tilemap;
mod views;
mod water;
mod windows;

pub const ABOUT: &str = "make the pictures in docs/images and in the noises' docs";

pub const HELP: &str = "
Usage: cargo xtask gallery [PRESET | studio | book]

Rewrites docs/images/: one relief map of each preset, the views of docs/render.md and the README's first picture, a
map sheet, the zoom of docs/levels.md, water as vectors, a tilemap, blocks, all palettes, the page of noises side by side, and the chunks around a viewer. Pictures of the studio's window stay. Then the pictures
of its start page, and docs/gallery.md: a map of each preset, and the shaded relief of a part of it at one pixel per sample, which shows artifacts that colors hide. Then
crates/orogen-noise/docs/gallery.md: the pictures at the top of the documentation of orogen-noise. They are embedded in the
file, so that every renderer shows them.

  PRESET  make the pictures of this preset alone, and docs/gallery.md
  book    write the recipes and the pictures of the tutorial, the cookbook and the pages for engines and ops from the pages'
          own commands; `cargo xtask clients book`, which may fail before, leaves the Python that runs their scripts
  studio  take the pictures of jobs in the studio that the last `cargo xtask clients studio` left
";

/// Makes the pictures.
pub fn run(args: &[String]) -> Result {
    let images = shell::root().join("docs/images");
    let listed = shell::capture(&mut shell::cargo("run --quiet --release --package orogen-cli -- presets"))?;
    let presets: Vec<(&str, &str)> = listed.lines().filter_map(|line| line.split_once(char::is_whitespace)).collect();
    match args {
        [] => {}
        [named] if named == "book" => return book_pictures(),
        [named] if named == "studio" => return windows::write(&images),
        [named] if presets.iter().any(|(preset, _)| preset == named) => {
            presets::write(named, &images)?;
            presets::page(&presets)?;
            return codegen::lists(shell::root(), false);
        }
        [named] => return Err(Failure::usage(format!("there is no preset '{named}'; `orogen presets` lists them"))),
        _ => return Err(Failure::usage("expected nothing or a preset")),
    }
    let kept = windows::read(&images)?;
    shell::empty_dir(&images)?;
    windows::restore(&images, kept)?;
    let work = shell::target_dir().join("gallery");
    for (preset, _) in &presets {
        presets::write(preset, &images)?;
    }
    presets::page(&presets)?;
    for (arguments, name) in [
        (&["map", "alpine", "--size", "1400"][..], "map.png"),
        (&["map", "tile-continent", "--color", "classes", "--size", "900"], "classes.png"),
        (&["map", "biomes", "--color", "biomes", "--size", "900"], "biome-map.png"),
        (&["palettes"], "palettes.png"),
    ] {
        let to = images.join(name);
        let mut orogen = shell::cargo("run --quiet --release --package orogen-cli --");
        shell::run(orogen.args(arguments).args(["--quiet", "-o"]).arg(&to))?;
        println!("{}", shell::relative(&to));
    }
    levels::write(&images, &work)?;
    views::write(&images)?;
    water::write(&images, &work)?;
    tilemap::write(&images, &work)?;
    blocks::write(&images)?;
    let page = images.join("compare.png");
    let mut orogen = shell::cargo("run --quiet --release --package orogen-cli -- compare --quiet -o");
    shell::run(orogen.arg(&page))?;
    println!("{}", shell::relative(&page));
    // The example writes into its working directory.
    let mut example = shell::cargo("run --quiet --release --package orogen --example infinite_terrain");
    shell::run(example.arg("--manifest-path").arg(shell::root().join("Cargo.toml")).current_dir(&work))?;
    let chunks = images.join("chunks.png");
    std::fs::copy(work.join("infinite_terrain.png"), &chunks).map_err(|e| on_file("write", &chunks, &e))?;
    println!("{}", shell::relative(&chunks));
    noises::write(&work)
}

/// The recipes and pictures of the pages whose commands are run.
fn book_pictures() -> Result {
    let programs = clients::book::programs();
    if !programs.packages.is_dir() {
        return Err(Failure::new("the scripts of the pages need Python; run `cargo xtask clients book` first"));
    }
    shell::run(&mut shell::cargo("build --quiet --release --package orogen-cli"))?;
    book::write(&programs, &shell::target_dir().join("gallery/book"))
}
