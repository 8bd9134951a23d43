//! Georeferencing beside formats that have none of their own: a world file and a `.prj`, and for pictures that GDAL opens also its `.aux.xml`.

use std::io;
use std::path::{Path, PathBuf};

use super::files::Files;
use super::layer_source::LayerSource;
use super::options::Options;
use super::sidecar::{self, NO_SIDECAR, SampleEncoding};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_io::file::{self, Existing, Output, Staged};
use orogen_io::format::affine::Affine;
use orogen_io::format::dem::Georeference;
use orogen_io::format::{aux_xml, world_file};
use orogen_io::open;

/// More bytes than any file that tells a place has.
const LONGEST: u64 = 1 << 20;

/// Writes both beside the output, or the `.prj` alone where the format has coordinates of its own (`from_south` is `None`). Returns the end of the closing message.
/// Nothing is written for a world without georeferencing, for a stream, and with `--no-sidecar`.
///
/// Fails as the files do, and if a file of that name lies there that tells another place.
pub fn write(
    files: &mut Files,
    source: &LayerSource,
    options: &Options,
    from_south: Option<bool>,
) -> io::Result<String> {
    let Some(path) = files.path().map(Path::to_path_buf) else { return Ok(String::new()) };
    write_for(files, &path, source, options, from_south)
}

/// Writes NAME.json and the location, of a format whose files tell everything but where they lie: only for a world that lies on a map.
///
/// Fails as [`write()`] and `write`.
pub fn write_on_map(
    files: &mut Files,
    source: &LayerSource,
    options: &Options,
    sample: &'static str,
) -> io::Result<String> {
    if source.map().is_none() {
        return Ok(String::new());
    }
    write_with_sidecar(files, source, options, &SampleEncoding { sample, ..SampleEncoding::default() })
}

/// Writes NAME.json, and beside it the world file and the `.prj`. Returns the words for both.
pub fn write_with_sidecar(
    files: &mut Files,
    source: &LayerSource,
    options: &Options,
    encoding: &SampleEncoding,
) -> io::Result<String> {
    let told = sidecar::write(files, source, options, encoding)?;
    Ok(told + &write(files, source, options, Some(encoding.from_south))?)
}

/// As [`write()`], of one of several files.
///
/// Fails as [`write()`].
pub fn write_for(
    files: &mut Files,
    path: &Path,
    source: &LayerSource,
    options: &Options,
    from_south: Option<bool>,
) -> io::Result<String> {
    let Some(map) = source.map() else { return Ok(String::new()) };
    if options.has(NO_SIDECAR.name) || files.path().is_some_and(|path| path.exists() && !path.is_file()) {
        return Ok(String::new());
    }
    let affine = from_south.map(|from_south| map.affine(source.window(), from_south));
    let (all, lacking) = companions(path, &map, affine)?;
    let mut written = Vec::new();
    for Companion { path: to, bytes, shared } in all {
        if shared && !files.replaces_all() {
            check(path, &to, &bytes)?;
        }
        written.push(to.file_name().unwrap_or_default().to_string_lossy().into_owned());
        files.write_beside(|_| to, |out| out.write_all(&bytes))?;
    }
    let words = match written.as_slice() {
        [] => String::new(),
        [one] => format!("; georeferenced by {one}"),
        [init @ .., last] => format!("; georeferenced by {} and {last}", init.join(", ")),
    };
    Ok(match lacking {
        Some(why) => format!("{words}; without its coordinate system: {why}"),
        None => words,
    })
}

/// A world file and a `.prj` speak of every file NAME, whatever its ending: of one that is there and is not written anew, too.
///
/// Fails if one is there that gives another location than what is written.
fn check(path: &Path, beside: &Path, bytes: &[u8]) -> Result<()> {
    let differs = || open::bytes(beside, "read", LONGEST).is_ok_and(|old| old.is_none_or(|old| old != bytes));
    if !beside.exists() || path.exists() || !differs() {
        return Ok(());
    }
    let message = format!(
        "cannot write {}: {} exists and gives another location, which readers would use; write to another name, or use --{} or --force",
        path.display(),
        beside.display(),
        NO_SIDECAR.name
    );
    Err(Error::new(ErrorKind::File, message))
}

/// Writes what stands beside a picture whose pixels lie on a map, all but putting it in its place.
///
/// # Errors
/// If a file cannot be written, or one is there that gives another location.
pub fn stage(output: &Output, map: &Georeference, affine: Affine) -> Result<Vec<Staged>> {
    let path = output.path();
    let (all, _) = companions(path, map, Some(affine)).map_err(|cause| file::explain("write", path, &cause))?;
    let stage = |Companion { path: to, bytes, shared }: Companion| {
        if shared && output.policy().existing() != Existing::Replace {
            check(path, &to, &bytes)?;
        }
        file::stage(&output.policy().output(to)?, |out| out.write_all(&bytes))
    };
    all.into_iter().map(stage).collect()
}

/// A file with the georeferencing of another.
struct Companion {
    /// Where it belongs.
    path: PathBuf,
    /// What is in it.
    bytes: Vec<u8>,
    /// Whether it speaks for every file of that name, whatever its ending.
    shared: bool,
}

/// What stands beside a raster: a world file where its file does not hold an `affine` itself, a `.prj`, and beside the pictures that it opens GDAL's own
/// notes. Also, why the coordinate system could not be told.
///
/// Fails never: what is written goes to memory.
fn companions(path: &Path, map: &Georeference, affine: Option<Affine>) -> io::Result<(Vec<Companion>, Option<String>)> {
    let wkt = map.wkt();
    let mut all = Vec::new();
    if let Some(affine) = affine {
        let mut bytes = Vec::new();
        world_file::write(&mut bytes, &affine)?;
        all.push(Companion { path: world_file::beside(path), bytes, shared: true });
        let extension = path.extension().unwrap_or_default();
        if let (true, Ok(wkt)) = (PICTURES.iter().any(|own| extension.eq_ignore_ascii_case(own)), &wkt) {
            let mut bytes = Vec::new();
            aux_xml::write(&mut bytes, &affine, wkt)?;
            // It is this file's alone, and GDAL writes it anew without asking.
            all.push(Companion { path: orogen_io::format::sidecar::aux_xml(path), bytes, shared: false });
        }
    }
    match wkt {
        Ok(wkt) => {
            all.push(Companion {
                path: path.with_extension("prj"),
                bytes: format!("{wkt}\n").into_bytes(),
                shared: true,
            });
            Ok((all, None))
        }
        Err(why) => Ok((all, Some(why))),
    }
}

/// The pictures whose coordinate system GDAL reads from its own notes alone.
const PICTURES: [&str; 3] = ["png", "pgm", "exr"];
