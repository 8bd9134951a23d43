//! The picture of a tilemap: a part of the preset `tile-island`.

use std::path::Path;

use crate::failure::{Result, on_file};
use crate::shell;

/// First column and row, columns and rows, in cells of the preset.
const WINDOW: &str = "48,30,56,38";

/// Writes it to a folder; `work` is for temporary files.
pub fn write(images: &Path, work: &Path) -> Result {
    let folder = work.join("tilemap");
    let mut orogen =
        shell::cargo("run --quiet --release --package orogen-cli -- tilemap tile-island --seed 6 --quiet --force");
    shell::run(orogen.args(["--window", WINDOW, "-o"]).arg(&folder))?;
    let to = images.join("tilemap.png");
    std::fs::copy(folder.join("preview.png"), &to).map_err(|e| on_file("write", &to, &e))?;
    println!("{}", shell::relative(&to));
    Ok(())
}
