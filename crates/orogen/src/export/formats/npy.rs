//! NumPy arrays.

use std::io;

use crate::export::files::Files;
use crate::export::format::Format;
use crate::export::options::Options;
use crate::export::subject::Subject;
use crate::format::npy;

/// The format.
pub static FORMAT: Format = Format {
    name: "npy",
    aliases: &[],
    about: "NumPy array of f32, the layer's own unit (metres for heights)",
    options: &[],
    channels: 1,
    memory: |_, _| 0,
    write,
};

fn write(subject: &mut Subject, _: &Options, files: &mut Files) -> io::Result<String> {
    let window = *subject.window();
    files.write(|out| {
        npy::write_header(out, window.width, window.height)?;
        subject.rows(|band| npy::write_rows(out, band[0].data()))
    })?;
    let levels = subject.levels();
    Ok(format!("{} to {}", levels.low(), levels.high()))
}
