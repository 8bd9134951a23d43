//! The zoom from continents to gullies, in the README and in docs/levels.md.

use std::path::Path;

use crate::failure::{Result, on_file};
use crate::shell;

/// The cells of the pictures, in metres.
const CELLS: [&str; 6] = ["7680", "960", "240", "60", "7.5", "0.9375"];

/// The window of each picture, with the origin of the preset `endless` in the middle.
const WINDOW: &str = "-256,-256,512,512";

/// A map sheet of a region with lakes.
const LAKES: &str =
    "--window=-2560,-2112,640,640 --cell 60 --no-contours --no-summits --no-title --size 900 --no-sidecar";

/// A map of `endless` at each cell, and a map sheet with lakes.
pub fn write(images: &Path, work: &Path) -> Result {
    for cell in CELLS {
        let mut orogen = shell::cargo("run --quiet --release --package orogen-cli -- generate endless --quiet");
        shell::run(orogen.args(["--window", WINDOW, "--cell", cell, "-o"]).arg(work))?;
        let to = images.join(format!("levels-{cell}.png"));
        std::fs::copy(work.join("map.png"), &to).map_err(|e| on_file("write", &to, &e))?;
        println!("{}", shell::relative(&to));
    }
    let to = images.join("lakes.png");
    let mut orogen = shell::cargo("run --quiet --release --package orogen-cli -- map endless --quiet --force");
    shell::run(orogen.args(LAKES.split(' ')).arg("-o").arg(&to))?;
    println!("{}", shell::relative(&to));
    Ok(())
}
