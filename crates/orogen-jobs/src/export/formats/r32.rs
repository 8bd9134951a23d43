//! Headerless floats.

use std::io;

use crate::export::files::Files;
use crate::export::format::Format;
use crate::export::layer_source::LayerSource;
use crate::export::memory::{aside, whole};
use crate::export::place;
use crate::export::quantizer::{self, FIRST_ROW, Quantizer};
use crate::export::sidecar::{NO_SIDECAR, SampleEncoding};
use crate::options::Options;
use orogen_io::format::raw;

/// The format.
pub static FORMAT: Format = Format {
    name: "r32",
    aliases: &[],
    about: "Headerless f32, little-endian, in the layer's unit; NAME.json holds the size",
    options: &[FIRST_ROW, NO_SIDECAR],
    channels: 1,
    features: false,
    memory: |window, options| if quantizer::from_south(options) { aside(whole(window)) } else { 0 },
    write,
};

fn write(source: &mut LayerSource, options: &Options, files: &mut Files) -> io::Result<String> {
    let mut quantized = Quantizer::plain(source, options, files)?;
    files.write(|out| quantized.rows(|samples| raw::write_f32(out, samples)))?;
    let from_south = quantizer::from_south(options);
    let encoding = SampleEncoding {
        sample: "f32",
        byte_order: Some("little"),
        levels: None,
        from_south,
        ..SampleEncoding::default()
    };
    let told = place::write_with_sidecar(files, source, options, &encoding)?;
    let levels = source.levels();
    Ok(format!("{} to {}{told}", levels.low(), levels.high()))
}
