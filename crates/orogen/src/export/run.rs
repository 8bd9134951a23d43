//! One export from beginning to end.

use std::io::{self, Write};
use std::path::Path;

use super::files::Files;
use super::format::Format;
use super::options::Options;
use super::registry;
use super::subject::Subject;
use crate::error::{Error, ErrorKind, Result};
use crate::file;

/// Exports to a file, and what stands beside it: all of it or nothing. Returns what the samples in it stand for, in words.
///
/// # Errors
/// If the format does not know an option or cannot hold the layer, memory does not suffice (then nothing was started), the work was cancelled, or
/// a file cannot be written.
pub fn to_file(format: &Format, subject: Subject, options: &Options, path: &Path) -> Result<String> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut subject = subject;
    prepare(format, &mut subject, options)?;
    file::check_folder(folder)?;
    let progress = subject.progress();
    write(format, &mut subject, options, Files::at(path, progress))
        .map_err(|cause| file::explain("write", path, &cause))
}

/// Exports to a stream: the file alone, nothing beside it.
///
/// # Errors
/// As [`to_file`]; what the stream itself fails with comes back as it is.
pub fn to_stream(format: &Format, subject: Subject, options: &Options, out: &mut dyn Write) -> io::Result<String> {
    let mut subject = subject;
    prepare(format, &mut subject, options)?;
    let progress = subject.progress();
    write(format, &mut subject, options, Files::stream(out, progress))
}

/// Refuses what cannot be, before anything is begun.
fn prepare(format: &Format, subject: &mut Subject, options: &Options) -> Result<()> {
    registry::check(format, options)?;
    if subject.channels() > format.channels {
        let several: Vec<&str> = (registry::all().iter())
            .filter(|other| other.channels >= subject.channels())
            .map(|other| other.name)
            .collect();
        let sentence = format!(
            "`{}` has {} channels and the format {} holds {}; those that hold it: {}",
            subject.layer(),
            subject.channels(),
            format.name,
            format.channels,
            several.join(", ")
        );
        return Err(Error::new(ErrorKind::Request, sentence));
    }
    subject.prepare((format.memory)(subject.window(), options))
}

fn write(format: &Format, subject: &mut Subject, options: &Options, mut files: Files) -> io::Result<String> {
    let words = (format.write)(subject, options, &mut files)?;
    files.commit()?;
    Ok(words)
}
