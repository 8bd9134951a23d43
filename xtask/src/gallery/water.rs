//! The picture of water as vectors: an SVG over the hillshade of the same window.

use std::path::Path;

use super::base64::base64;
use crate::failure::{Failure, Result, on_file};
use crate::shell;

/// A part of `alpine`: first column and row, columns and rows, at a cell of 60 m.
const WINDOW: [usize; 4] = [560, 120, 420, 300];
const CELL: usize = 60;

/// Writes it to a folder; `work` is for temporary files.
pub fn write(images: &Path, work: &Path) -> Result {
    let window = WINDOW.map(|number| number.to_string()).join(",");
    let export = |name: &str, arguments: &[&str]| {
        let file = work.join(name);
        let mut orogen = shell::cargo("run --quiet --release --package orogen-cli -- export alpine --quiet --force");
        shell::run(orogen.args(["--window", &window]).args(arguments).arg("-o").arg(&file))?;
        std::fs::read(&file).map_err(|e| on_file("read", &file, &e))
    };
    let shade = export("hillshade.png", &["--layer", "hillshade", "--bits", "8"])?;
    let drawing = export("water.svg", &["--layer", "rivers,lakes,watersheds,summits"])?;
    let drawing = String::from_utf8(drawing).map_err(|_| Failure::new("the drawing is not UTF-8"))?;
    let Some((head, body)) = drawing.split_once('\n') else { return Err(Failure::new("the drawing has no lines")) };
    // Coordinates of lines start at the center of the first sample, coordinates of pictures at its corner.
    let [_, _, columns, rows] = WINDOW.map(|samples| samples * CELL);
    let corner = CELL / 2;
    let source = base64(&shade);
    let picture = format!(
        "<image x=\"-{corner}\" y=\"-{corner}\" width=\"{columns}\" height=\"{rows}\" preserveAspectRatio=\"none\" \
         href=\"data:image/png;base64,{source}\"/>"
    );
    let to = images.join("water.svg");
    shell::write(&to, &format!("{head}\n{picture}\n{body}"))?;
    println!("{}", shell::relative(&to));
    Ok(())
}
