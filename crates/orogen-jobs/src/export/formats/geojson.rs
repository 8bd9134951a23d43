//! Contours and vector features as GeoJSON.

use std::io;

use crate::export::features::drawing::{self, Drawing};
use crate::export::files::Files;
use crate::export::format::Format;
use crate::export::layer_source::LayerSource;
use crate::options::Options;
use orogen_io::format::geojson;

/// The format.
pub static FORMAT: Format =
    drawing::format("geojson", "GeoJSON: contour lines or vector features, in local metres or georeferenced", write);

fn write(source: &mut LayerSource, options: &Options, files: &mut Files) -> io::Result<String> {
    let mut drawing = Drawing::of(source, options)?;
    drawing.place();
    let layer = drawing.only("geojson")?;
    files.write(|out| geojson::write(out, layer, drawing.crs(), drawing.step()))?;
    Ok(drawing.words_with_crs())
}
