//! Contours and vector features as SVG.

use std::io;

use crate::export::features::drawing::{self, Drawing};
use crate::export::features::svg as drawn;
use crate::export::files::Files;
use crate::export::format::Format;
use crate::export::layer_source::LayerSource;
use crate::options::Options;
use orogen_io::format::contour_svg;

/// The format.
pub static FORMAT: Format = drawing::format("svg", "SVG drawing of contour lines or vector features, in metres", write);

fn write(source: &mut LayerSource, options: &Options, files: &mut Files) -> io::Result<String> {
    let window = *source.window();
    if !source.vectors().is_empty() {
        let drawing = Drawing::of(source, options)?;
        files.write(|out| drawn::write(out, &drawing.layers, &window))?;
        return Ok(drawing.words());
    }
    let found = drawing::contours(source, options)?;
    files.write(|out| contour_svg::write(out, &found.lines, &window, found.interval))?;
    Ok(found.words(source.unit()))
}
