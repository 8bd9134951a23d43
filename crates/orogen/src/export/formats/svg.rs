//! Contours as a drawing.

use std::io;

use crate::contour::svg;
use crate::export::contours;
use crate::export::files::Files;
use crate::export::format::Format;
use crate::export::options::Options;
use crate::export::subject::Subject;

/// The format.
pub static FORMAT: Format = Format {
    name: "svg",
    aliases: &[],
    about: "contour lines as a drawing, its unit the metre",
    options: contours::OPTIONS,
    channels: 1,
    memory: contours::memory,
    write,
};

fn write(subject: &mut Subject, options: &Options, files: &mut Files) -> io::Result<String> {
    let found = contours::of(subject, options)?;
    let window = *subject.window();
    files.write(|out| svg::write(out, &found.lines, &window, found.interval))?;
    Ok(found.words(subject.unit()))
}
