//! ESRI ASCII grid.

use std::io;

use crate::export::files::Files;
use crate::export::format::Format;
use crate::export::layer_source::LayerSource;
use crate::export::place;
use crate::export::sidecar::NO_SIDECAR;
use crate::options::Options;
use orogen_io::format::asc;

/// The format.
pub static FORMAT: Format = Format {
    name: "asc",
    aliases: &[],
    about: "ESRI ASCII grid (text), in local metres or georeferenced with NAME.prj",
    options: &[NO_SIDECAR],
    channels: 1,
    features: false,
    memory: |_, _| 0,
    write,
};

fn write(source: &mut LayerSource, options: &Options, files: &mut Files) -> io::Result<String> {
    let (window, map) = (*source.window(), source.map());
    files.write(|out| {
        asc::write_head(out, &window, map.as_ref())?;
        source.rows(|band| asc::write_rows(out, window.width, band[0].data()))
    })?;
    let levels = source.levels();
    let told = place::write(files, source, options, None)?;
    Ok(format!("{} to {}{told}", levels.low(), levels.high()))
}
