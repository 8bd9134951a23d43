//! Headerless whole numbers.

use std::io;

use crate::export::files::Files;
use crate::export::format::Format;
use crate::export::layer_source::LayerSource;
use crate::export::memory::{aside, whole};
use crate::export::options::Options;
use crate::export::place;
use crate::export::quantizer::{self, FIRST_ROW, Quantizer, RANGE};
use crate::export::sidecar::{self, NO_SIDECAR, SampleEncoding};
use crate::format::raw;

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
    let mut spread = Quantizer::new(source, options, u16::MAX, files)?;
    let levels = spread.levels();
    files.write(|out| spread.rows(|samples| raw::write_u16(out, samples, &levels)))?;
    let from_south = quantizer::from_south(options);
    let held = SampleEncoding {
        sample: "u16",
        byte_order: Some("little"),
        levels: Some(levels),
        from_south,
        ..SampleEncoding::default()
    };
    let told =
        sidecar::write(files, source, options, &held)? + &place::write(files, source, options, Some(held.from_south))?;
    Ok(quantizer::words(&levels, u16::MAX) + &told)
}
