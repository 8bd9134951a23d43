//! Vector features as FlatGeobuf.

use std::io;

use crate::export::features::drawing::{self, Drawing};
use crate::export::files::Files;
use crate::export::format::Format;
use crate::export::layer_source::LayerSource;
use crate::options::Options;
use orogen_io::format::fgb;

/// The format.
pub static FORMAT: Format =
    drawing::format("fgb", "FlatGeobuf: contour lines or vector features, one layer with a spatial index", write);

fn write(source: &mut LayerSource, options: &Options, files: &mut Files) -> io::Result<String> {
    let mut drawing = Drawing::of(source, options)?;
    drawing.place();
    let layer = drawing.only("fgb")?;
    files.write(|out| fgb::write(out, layer, drawing.crs()))?;
    Ok(drawing.words_with_crs())
}
