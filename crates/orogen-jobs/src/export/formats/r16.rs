//! Headerless 16-bit integers.

use std::io;

use crate::export::files::Files;
use crate::export::format::Format;
use crate::export::layer_source::LayerSource;
use crate::export::memory::{aside, whole};
use crate::export::place;
use crate::export::quantizer::{self, FIRST_ROW, Quantizer, RANGE};
use crate::export::sidecar::{NO_SIDECAR, SampleEncoding};
use crate::options::Options;
use orogen_io::format::raw;

/// The format.
pub static FORMAT: Format = Format {
    name: "r16",
    aliases: &["raw"],
    about: "Headerless u16, little-endian, scaled to the range of the window; NAME.json holds the range",
    options: &[RANGE, FIRST_ROW, NO_SIDECAR],
    channels: 1,
    features: false,
    memory: |window, _| aside(whole(window)),
    write,
};

fn write(source: &mut LayerSource, options: &Options, files: &mut Files) -> io::Result<String> {
    let mut quantized = Quantizer::new(source, options, u16::MAX, files)?;
    let levels = quantized.levels();
    files.write(|out| quantized.rows(|samples| raw::write_u16(out, samples, &levels)))?;
    let from_south = quantizer::from_south(options);
    let encoding = SampleEncoding::of_levels(levels, u16::MAX, "little", from_south);
    let told = place::write_with_sidecar(files, source, options, &encoding)?;
    Ok(quantizer::words(&levels, u16::MAX) + &told)
}
