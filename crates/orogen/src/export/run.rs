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
    let (files, words) = staged(format, subject, options, path)?;
    files.commit().map_err(|cause| file::explain("write", path, &cause))?;
    Ok(words)
}

/// As [`to_file`], all but putting the files in their places: for exports of several.
pub(super) fn staged<'w>(
    format: &Format,
    mut subject: Subject<'w>,
    options: &Options,
    path: &Path,
) -> Result<(Files<'w>, String)> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    prepare(format, &mut subject, options)?;
    file::check_folder(folder)?;
    let mut files = Files::at(path, subject.progress());
    let words =
        (format.write)(&mut subject, options, &mut files).map_err(|cause| file::explain("write", path, &cause))?;
    Ok((files, words))
}

/// Exports to a stream: the file alone, nothing beside it.
///
/// # Errors
/// As [`to_file`]; what the stream itself fails with comes back as it is.
pub fn to_stream(format: &Format, subject: Subject, options: &Options, out: &mut dyn Write) -> io::Result<String> {
    let mut subject = subject;
    prepare(format, &mut subject, options)?;
    let mut files = Files::stream(out, subject.progress());
    let words = (format.write)(&mut subject, options, &mut files)?;
    files.commit()?;
    Ok(words)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::full_disk::Full;
    use crate::grid::Window;
    use crate::progress::Progress;
    use crate::recipe::document::Recipe;
    use crate::world::World;

    #[test]
    fn every_format_is_written_whole_or_fails_with_its_writer() {
        let text = "orogen = 1\n[nodes.a]\nop = \"fbm\"\nwavelength = 40\n[nodes.b]\nop = \"remap\"\nsource = \"a\"\nto = [0, 90]\n\
                    [outputs]\nheight = \"b\"\n";
        let world = World::open(Recipe::parse(text, "test").unwrap()).unwrap();
        let progress = Progress::none();
        for format in registry::all() {
            // SRTM's tiles have sizes of their own.
            let side = if format.name == "hgt" { 1201 } else { 40 };
            let write = |out: &mut dyn Write| {
                let subject = Subject::new(&world, "height", Window::new(side, side, 2.0), &progress).unwrap();
                to_stream(format, subject, &Options::default(), out)
            };
            let mut whole = Vec::new();
            let words = write(&mut whole).unwrap();
            assert!(whole.len() > 100 && !words.is_empty(), "{}: {words}", format.name);
            for left in [0, 1, 50, whole.len() / 2, whole.len() - 1] {
                let failed = write(&mut Full { left }).unwrap_err();
                assert_eq!(failed.kind(), io::ErrorKind::StorageFull, "{} after {left}: {failed}", format.name);
            }
            progress.check().unwrap();
        }
    }

    #[test]
    fn a_stopped_export_leaves_nothing() {
        let text = "orogen = 1\n[nodes.a]\nop = \"constant\"\n[outputs]\nheight = \"a\"\n";
        let world = World::open(Recipe::parse(text, "test").unwrap()).unwrap();
        let folder = std::env::temp_dir().join(format!("orogen-export-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        for name in ["png", "r16", "tif", "exr"] {
            let progress = Progress::none();
            progress.cancel();
            let subject = Subject::new(&world, "height", Window::new(30, 30, 2.0), &progress).unwrap();
            let path = folder.join("a").with_extension(name);
            let error = to_file(registry::named(name).unwrap(), subject, &Options::default(), &path).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::Cancelled, "{name}");
        }
        assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 0);
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
