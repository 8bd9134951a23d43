//! Contours as GeoJSON.

use std::io;

use crate::contour::geojson;
use crate::export::contours;
use crate::export::files::Files;
use crate::export::format::Format;
use crate::export::options::Options;
use crate::export::subject::Subject;

/// The format.
pub static FORMAT: Format = Format {
    name: "geojson",
    aliases: &[],
    about: "contour lines, in local metres, or where a real place lies",
    options: contours::OPTIONS,
    channels: 1,
    memory: contours::memory,
    write,
};

fn write(subject: &mut Subject, options: &Options, files: &mut Files) -> io::Result<String> {
    let found = contours::of(subject, options)?;
    let (cell, map) = (subject.window().cell, subject.map());
    files.write(|out| geojson::write(out, &found.lines, cell, found.interval, map.as_ref()))?;
    Ok(found.words(subject.unit()))
}
