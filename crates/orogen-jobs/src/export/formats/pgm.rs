//! Netpbm grayscale pictures.

use std::io;

use crate::export::files::Files;
use crate::export::format::Format;
use crate::export::layer_source::LayerSource;
use crate::export::memory::{aside, whole};
use crate::export::place;
use crate::export::quantizer::{self, BITS, FIRST_ROW, Quantizer, RANGE};
use crate::export::sidecar::{NO_SIDECAR, SampleEncoding};
use crate::options::Options;
use orogen_io::format::{notes, pgm};

/// The format.
pub static FORMAT: Format = Format {
    name: "pgm",
    aliases: &[],
    about: "Netpbm grey picture (PGM) of 16 or 8 bits, scaled to the range of the window",
    options: &[BITS, RANGE, FIRST_ROW, NO_SIDECAR],
    channels: 1,
    features: false,
    memory: |window, _| aside(whole(window)),
    write,
};

fn write(source: &mut LayerSource, options: &Options, files: &mut Files) -> io::Result<String> {
    let (window, most) = (*source.window(), quantizer::most(options));
    let mut quantized = Quantizer::new(source, options, most, files)?;
    let levels = quantized.levels();
    let notes: Vec<String> = notes::of_heights(window.cell, &levels).into_iter().map(|(_, text)| text).collect();
    files.write(|out| {
        pgm::write_head(out, [window.width, window.height], most, &notes)?;
        quantized.rows(|samples| quantizer::write_levels(out, samples, &levels, most))
    })?;
    let encoding = SampleEncoding::of_levels(levels, most, "big", quantizer::from_south(options));
    let told = place::write_with_sidecar(files, source, options, &encoding)?;
    Ok(quantizer::words(&levels, most) + &told)
}
