//! The steps of an export.

use std::io::{self, Write};

use super::files::Files;
use super::format::Format;
use super::layer_source::LayerSource;
use super::{features, registry};
use crate::options::Options;
use orogen_engine::world::World;
use orogen_grid::analysis::finite::FiniteCount;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;
use orogen_grid::progress::Progress;
use orogen_io::file::{self, Output};

/// The result of an export.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Written {
    /// A description of the samples.
    pub words: String,
    /// The count of samples.
    pub count: FiniteCount,
}

/// The source for a format: layers of vector features, if the format holds them and all `layers` (comma-separated
/// names) are such layers; otherwise the layer with that name, as in [`LayerSource::new`].
///
/// # Errors
/// The errors of [`LayerSource::new`]; or if the layers are vector features and the format does not hold them.
pub(super) fn source<'w>(
    format: &Format,
    world: &'w World,
    layers: &str,
    window: Window,
    progress: &Progress,
) -> Result<LayerSource<'w>> {
    match features::list::listed(layers) {
        Some(vectors) if format.features => LayerSource::of_features(world, vectors, window, progress),
        Some(vectors) if vectors.len() > 1 || world.unit(layers).is_err() => {
            let holds: Vec<String> = registry::all()
                .iter()
                .filter(|format| format.features)
                .map(|format| format!(".{}", format.name))
                .collect();
            let message = format!(
                "`{layers}` consists of vector features, which .{} cannot hold; formats that can: {}",
                format.name,
                holds.join(", ")
            );
            Err(Error::new(ErrorKind::Request, message))
        }
        _ => LayerSource::new(world, layers, window, progress),
    }
}

/// Exports to a file and its sidecars, atomically.
///
/// # Errors
/// If the format does not have an option or cannot hold the layer, no sample is finite, memory does not suffice (then
/// no work was started), the work was cancelled, or a file cannot be written.
pub(super) fn to_file(format: &Format, source: LayerSource, options: &Options, output: &Output) -> Result<Written> {
    let (files, written) = staged(format, source, options, output)?;
    files.commit().map_err(|cause| file::explain("write", output.path(), &cause))?;
    Ok(written)
}

/// [`to_file`] without putting the files in place, to commit several exports together.
pub(super) fn staged<'w>(
    format: &Format,
    mut source: LayerSource<'w>,
    options: &Options,
    output: &'w Output,
) -> Result<(Files<'w>, Written)> {
    let path = output.path();
    prepare(format, &mut source, options)?;
    file::check_folder(file::folder(path))?;
    let mut files = Files::at(output, source.progress());
    let words =
        write(format, &mut source, options, &mut files).map_err(|cause| file::explain("write", path, &cause))?;
    Ok((files, written(&source, words)?))
}

/// Exports to a stream, without sidecars.
///
/// # Errors
/// The errors of [`to_file`]; errors of the stream itself are returned unchanged.
pub(super) fn to_stream(
    format: &Format,
    source: LayerSource,
    options: &Options,
    out: &mut dyn Write,
) -> io::Result<Written> {
    let mut source = source;
    prepare(format, &mut source, options)?;
    let mut files = Files::stream(out, source.progress());
    let words = write(format, &mut source, options, &mut files)?;
    let written = written(&source, words)?;
    files.commit()?;
    Ok(written)
}

/// Calls the format's writer. If the layer has no finite sample, that error takes precedence over the format's error.
fn write(format: &Format, source: &mut LayerSource, options: &Options, files: &mut Files) -> io::Result<String> {
    (format.write)(source, options, files).map_err(|cause| {
        let own = cause.get_ref().and_then(|inner| inner.downcast_ref::<Error>());
        match (own.map(Error::kind), finite(source)) {
            (Some(ErrorKind::Request), Err(error)) => error.into(),
            _ => cause,
        }
    })
}

/// The result for a source; fails if none of its samples is finite.
fn written(source: &LayerSource, words: String) -> Result<Written> {
    finite(source)?;
    Ok(Written { words, count: source.count() })
}

fn finite(source: &LayerSource) -> Result<()> {
    source.count().check(&format!("the layer `{}`", source.layer())).map(drop)
}

/// Rejects invalid requests before the work begins.
fn prepare(format: &Format, source: &mut LayerSource, options: &Options) -> Result<()> {
    registry::check(format, options)?;
    if source.channels() > format.channels {
        let several: Vec<&str> = (registry::all().iter())
            .filter(|other| other.channels >= source.channels())
            .map(|other| other.name)
            .collect();
        let message = format!(
            "`{}` has {} channels, and the format {} holds {}; formats for it: {}",
            source.layer(),
            source.channels(),
            format.name,
            format.channels,
            several.join(", ")
        );
        return Err(Error::new(ErrorKind::Request, message));
    }
    source.prepare((format.memory)(source.window(), options))
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_engine::recipe::document::Recipe;
    use orogen_engine::world::World;
    use orogen_grid::grid::Window;
    use orogen_grid::progress::Progress;
    use orogen_io::file::OutputPolicy;
    use orogen_io::full_disk::Full;
    use orogen_io::test_folder::TestFolder;

    #[test]
    fn every_format_is_written_whole_or_fails_with_its_writer() {
        let text = "orogen = 1\n[nodes.a]\nop = \"fbm\"\nwavelength = 40\n[nodes.b]\nop = \"remap\"\nsource = \"a\"\nto = [0, 90]\n\
                    [outputs]\nheight = \"b\"\n";
        let world = World::open(Recipe::parse(text, "test").unwrap()).unwrap();
        let progress = Progress::none();
        // These formats hold only objects.
        for format in registry::all().iter().filter(|format| !matches!(format.name, "json" | "tres")) {
            // SRTM tiles have fixed sizes.
            let side = if format.name == "hgt" { 1201 } else { 40 };
            let write = |out: &mut dyn Write| {
                let source = LayerSource::new(&world, "height", Window::new(side, side, 2.0), &progress).unwrap();
                to_stream(format, source, &Options::default(), out)
            };
            let mut whole = Vec::new();
            let words = write(&mut whole).unwrap().words;
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
        let folder = TestFolder::new("export").unwrap();
        for name in ["png", "r16", "tif", "exr"] {
            let progress = Progress::none();
            progress.cancel();
            let source = LayerSource::new(&world, "height", Window::new(30, 30, 2.0), &progress).unwrap();
            let path = folder.join("a").with_extension(name);
            let output = OutputPolicy::default().output(&path).unwrap();
            let error = to_file(registry::named(name).unwrap(), source, &Options::default(), &output).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::Cancelled, "{name}");
        }
        assert!(folder.names().is_empty());
    }
}
