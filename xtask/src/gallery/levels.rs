//! The zoom from continents to gullies, in the README and in docs/levels.md.

use std::path::Path;

use crate::failure::{Result, on_file};
use crate::shell;

/// The cells of the pictures, in metres.
const CELLS: [&str; 6] = ["7680", "960", "240", "60", "7.5", "0.9375"];

/// The window of each picture: the origin of the preset `endless` lies in its middle.
const WINDOW: &str = "-256,-256,512,512";

/// The window of the picture of lakes, at 60 m.
const LAKES: &str = "-1850,-1750,900,900";

/// A map of `endless` at each cell, and one of a region with lakes.
pub fn write(images: &Path, work: &Path) -> Result {
    let picture = |window: &str, cell: &str, name: &str| {
        let mut orogen = shell::cargo("run --quiet --release --package orogen-cli -- generate endless --quiet");
        shell::run(orogen.args([&format!("--window={window}"), "--cell", cell, "-o"]).arg(work))?;
        let to = images.join(name);
        std::fs::copy(work.join("map.png"), &to).map_err(|e| on_file("write", &to, &e))?;
        println!("{}", shell::relative(&to));
        Ok(())
    };
    for cell in CELLS {
        picture(WINDOW, cell, &format!("levels-{cell}.png"))?;
    }
    picture(LAKES, "60", "lakes.png")
}
