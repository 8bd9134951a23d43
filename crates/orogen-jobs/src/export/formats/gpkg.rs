//! Vector features as OGC GeoPackage.

use std::io;

use crate::export::features::drawing::{self, Drawing};
use crate::export::files::Files;
use crate::export::format::Format;
use crate::export::layer_source::LayerSource;
use crate::options::Options;
use orogen_io::format::gpkg;

/// The format.
pub static FORMAT: Format = drawing::format(
    "gpkg",
    "GeoPackage: contour lines or vector features, any number of layers with spatial indexes",
    write,
);

fn write(source: &mut LayerSource, options: &Options, files: &mut Files) -> io::Result<String> {
    let mut drawing = Drawing::of(source, options)?;
    drawing.place();
    files.write(|out| gpkg::write(out, drawing.layers.iter().map(|(layer, _)| layer), drawing.crs()))?;
    Ok(drawing.words_with_crs())
}
