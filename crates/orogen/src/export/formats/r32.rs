//! Headerless floats.

use std::io;

use crate::export::files::Files;
use crate::export::format::Format;
use crate::export::memory::{aside, whole};
use crate::export::options::Options;
use crate::export::place;
use crate::export::sidecar::{self, Held, NO_SIDECAR};
use crate::export::spread::{self, FIRST_ROW, Spread};
use crate::export::subject::Subject;
use crate::format::raw;

/// The format.
pub static FORMAT: Format = Format {
    name: "r32",
    aliases: &[],
    about: "Headerless f32, little-endian, the layer's own unit, the size told in NAME.json",
    options: &[FIRST_ROW, NO_SIDECAR],
    channels: 1,
    features: false,
    memory: |window, options| if spread::from_south(options) { aside(whole(window)) } else { 0 },
    write,
};

fn write(subject: &mut Subject, options: &Options, files: &mut Files) -> io::Result<String> {
    let mut spread = Spread::plain(subject, options, files)?;
    files.write(|out| spread.rows(|samples| raw::write_f32(out, samples)))?;
    let from_south = spread::from_south(options);
    let held = Held { sample: "f32", byte_order: Some("little"), levels: None, from_south, ..Held::default() };
    let told = sidecar::write(files, subject, options, &held)?
        + &place::write(files, subject, options, Some(held.from_south))?;
    let levels = subject.levels();
    Ok(format!("{} to {}{told}", levels.low(), levels.high()))
}
