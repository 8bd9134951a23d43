//! Cloud-Optimized GeoTIFF.

use std::io;

use crate::export::files::Files;
use crate::export::format::Format;
use crate::export::layer_source::LayerSource;
use crate::export::memory::{aside, whole};
use crate::options::Options;
use orogen_grid::grid::Window;
use orogen_io::format::geotiff::options::Options as Layout;
use orogen_io::format::geotiff::writer::Writer;

/// The format.
pub static FORMAT: Format = Format {
    name: "tif",
    aliases: &["tiff"],
    about: "Cloud-Optimized GeoTIFF of f32 with overviews, in local metres or georeferenced",
    options: &[],
    channels: 1,
    features: false,
    memory,
    write,
};

/// One row of tiles per level while the next one is filled, the same again during compression, and compressed tiles
/// that are not yet written.
fn memory(window: &Window, _: &Options) -> u64 {
    aside(whole(window)).saturating_add((window.width as u64).saturating_mul(4 * 4 * 512))
}

fn write(source: &mut LayerSource, _: &Options, files: &mut Files) -> io::Result<String> {
    let layout = Layout::of_unit(source.unit()).with_map(source.map());
    let mut writer = Writer::new(source.window(), &layout, files.spool())?;
    files.write(|out| {
        source.rows(|band| writer.rows(band[0].data()))?;
        writer.finish(out)
    })?;
    let levels = source.levels();
    Ok(format!("{} to {}", levels.low(), levels.high()))
}
