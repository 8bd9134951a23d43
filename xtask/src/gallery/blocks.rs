//! The picture of a world of blocks: the preset `caves`.

use std::path::Path;

use crate::failure::Result;
use crate::shell;

/// Writes it to a folder.
pub fn write(images: &Path) -> Result {
    let to = images.join("blocks.png");
    let mut orogen = shell::cargo("run --quiet --release --package orogen-cli -- blocks caves --quiet --force -o");
    shell::run(orogen.arg(&to))?;
    println!("{}", shell::relative(&to));
    Ok(())
}
