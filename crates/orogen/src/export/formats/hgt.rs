//! SRTM tiles.

use std::io;

use crate::export::files::Files;
use crate::export::format::{Format, refuse};
use crate::export::options::Options;
use crate::export::subject::Subject;
use crate::format::hgt::{self, SIZES};

/// The format.
pub static FORMAT: Format = Format {
    name: "hgt",
    aliases: &[],
    about: "SRTM tile of 1201 x 1201 or 3601 x 3601 samples: whole metres, rounded to the nearest, big-endian",
    options: &[],
    channels: 1,
    memory: |_, _| 0,
    write,
};

fn write(subject: &mut Subject, _: &Options, files: &mut Files) -> io::Result<String> {
    let window = *subject.window();
    if !SIZES.contains(&[window.width, window.height]) {
        let square = if window.width.max(window.height) < 2401 { 1201 } else { 3601 };
        return refuse(format!(
            "an .hgt has 1201 x 1201 or 3601 x 3601 samples, and these are {} x {}: the nearest is --window {},{},{square},{square}",
            window.width, window.height, window.x, window.y
        ));
    }
    let name = files.path().map(|path| path.to_string_lossy().into_owned()).unwrap_or_default();
    files.write(|out| subject.rows(|band| hgt::write(out, band[0].data())))?;
    let levels = subject.levels();
    let place = match hgt::corner(&name) {
        Some([south, west]) => format!("its south-west corner at {south} north, {west} east"),
        None => "no place: a name such as N46E007.hgt tells readers its south-west corner".to_string(),
    };
    Ok(format!("{} to {}, rounded to whole metres; {place}", levels.low(), levels.high()))
}
