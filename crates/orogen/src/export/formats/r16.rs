//! Headerless whole numbers.

use std::io;

use crate::export::files::Files;
use crate::export::format::Format;
use crate::export::memory::{aside, whole};
use crate::export::options::Options;
use crate::export::place;
use crate::export::sidecar::{self, Held, NO_SIDECAR};
use crate::export::spread::{self, FIRST_ROW, RANGE, Spread};
use crate::export::subject::Subject;
use crate::format::raw;

/// The format.
pub static FORMAT: Format = Format {
    name: "r16",
    aliases: &["raw"],
    about: "Headerless whole numbers of 16 bits, little-endian, over the range of the window, told in NAME.json",
    options: &[RANGE, FIRST_ROW, NO_SIDECAR],
    channels: 1,
    features: false,
    memory: |window, _| aside(whole(window)),
    write,
};

fn write(subject: &mut Subject, options: &Options, files: &mut Files) -> io::Result<String> {
    let mut spread = Spread::new(subject, options, u16::MAX, files)?;
    let levels = spread.levels();
    files.write(|out| spread.rows(|samples| raw::write_u16(out, samples, &levels)))?;
    let from_south = spread::from_south(options);
    let held = Held { sample: "u16", byte_order: Some("little"), levels: Some(levels), from_south, ..Held::default() };
    let told = sidecar::write(files, subject, options, &held)?
        + &place::write(files, subject, options, Some(held.from_south))?;
    Ok(spread::words(&levels, u16::MAX) + &told)
}
