//! ESRI's ASCII grid.

use std::io;

use crate::export::files::Files;
use crate::export::format::Format;
use crate::export::options::Options;
use crate::export::place;
use crate::export::sidecar::NO_SIDECAR;
use crate::export::subject::Subject;
use crate::format::asc;

/// The format.
pub static FORMAT: Format = Format {
    name: "asc",
    aliases: &[],
    about: "ESRI ASCII grid: numbers as text, in local metres or on the map of a real place, with NAME.prj",
    options: &[NO_SIDECAR],
    channels: 1,
    features: false,
    memory: |_, _| 0,
    write,
};

fn write(subject: &mut Subject, options: &Options, files: &mut Files) -> io::Result<String> {
    let (window, map) = (*subject.window(), subject.map());
    files.write(|out| {
        asc::write_head(out, &window, map.as_ref())?;
        subject.rows(|band| asc::write_rows(out, window.width, band[0].data()))
    })?;
    let levels = subject.levels();
    let told = place::write(files, subject, options, None)?;
    Ok(format!("{} to {}{told}", levels.low(), levels.high()))
}
