//! A format for the test of adding things.

use std::io;

use crate::export::files::Files;
use crate::export::format::Format;
use crate::export::layer_source::LayerSource;
use crate::options::Options;
use orogen_io::format::raw;

/// The format.
pub static FORMAT: Format = Format {
    name: "added",
    aliases: &[],
    about: "Headerless f32, little-endian, for the test of adding things",
    options: &[],
    channels: 1,
    features: false,
    memory: |_, _| 0,
    write,
};

fn write(source: &mut LayerSource, _: &Options, files: &mut Files) -> io::Result<String> {
    files.write(|out| source.rows(|band| raw::write_f32(out, band[0].data())))?;
    Ok("as they are".to_owned())
}
