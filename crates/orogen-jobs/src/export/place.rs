//! Georeferencing for formats that cannot store it: a world file and a `.prj`, and an `.aux.xml` for pictures that GDAL
//! opens.

use std::io;
use std::path::{Path, PathBuf};

use super::files::Files;
use super::layer_source::LayerSource;
use super::sidecar::{self, NO_SIDECAR, SampleEncoding};
use crate::options::Options;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_io::file::{self, Existing, Output, Staged};
use orogen_io::format::affine::Affine;
use orogen_io::format::dem::Georeference;
use orogen_io::format::{aux_xml, world_file};
use orogen_io::{fs, open};

/// Upper limit for the size of a georeferencing file, in bytes.
const LONGEST: u64 = 1 << 20;

/// Writes both sidecars, or only the `.prj` if the format stores coordinates itself (`from_south` is `None`). Returns
/// the end of the final message. Writes nothing for a world without georeferencing, for a stream, or with
/// `--no-sidecar`.
///
/// Fails if the files fail, or if a file with that name exists and contains another position.
pub fn write(
    files: &mut Files,
    source: &LayerSource,
    options: &Options,
    from_south: Option<bool>,
) -> io::Result<String> {
    let Some(path) = files.path().map(Path::to_path_buf) else { return Ok(String::new()) };
    write_for(files, &path, source, options, from_south)
}

/// Writes NAME.json and the georeferencing for a format that stores everything except its position: only for a world on
/// a map.
///
/// Fails under the same conditions as [`write()`] and `write`.
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

/// Writes NAME.json, the world file and the `.prj`. Returns the message parts for both.
pub fn write_with_sidecar(
    files: &mut Files,
    source: &LayerSource,
    options: &Options,
    encoding: &SampleEncoding,
) -> io::Result<String> {
    let told = sidecar::write(files, source, options, encoding)?;
    Ok(told + &write(files, source, options, Some(encoding.from_south))?)
}

/// [`write()`] for one of several files.
///
/// Fails under the same conditions as [`write()`].
pub fn write_for(
    files: &mut Files,
    path: &Path,
    source: &LayerSource,
    options: &Options,
    from_south: Option<bool>,
) -> io::Result<String> {
    let Some(map) = source.map() else { return Ok(String::new()) };
    if options.has(NO_SIDECAR.name) || files.path().is_some_and(|path| fs::is_present(path) && !fs::is_file(path)) {
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

/// Checks a sidecar. A world file and a `.prj` apply to every file NAME, whatever its extension, including existing
/// files that are not written now.
///
/// Fails if one exists with another position than the new one.
fn check(path: &Path, beside: &Path, bytes: &[u8]) -> Result<()> {
    let differs = || open::bytes(beside, "read", LONGEST).is_ok_and(|old| old.is_none_or(|old| old != bytes));
    if !fs::is_present(beside) || fs::is_present(path) || !differs() {
        return Ok(());
    }
    let message = format!(
        "cannot write {}: {} exists and contains another position, which readers would use; write to another name, or use --{} or --force",
        path.display(),
        beside.display(),
        NO_SIDECAR.name
    );
    Err(Error::new(ErrorKind::File, message))
}

/// Stages the sidecars of a georeferenced picture.
///
/// # Errors
/// If a file cannot be written, or one exists with another position.
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

/// A sidecar with the georeferencing of a file.
struct Companion {
    /// The path.
    path: PathBuf,
    /// The content.
    bytes: Vec<u8>,
    /// Whether it applies to every file with that name, whatever the extension.
    shared: bool,
}

/// The sidecars of a raster: a world file if its format does not store `affine`, a `.prj`, and GDAL's sidecar for
/// pictures that GDAL opens. Also returns the reason if the coordinate system cannot be expressed.
///
/// Never fails, because it writes to memory.
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
            // This sidecar belongs to one file only, and GDAL overwrites it without asking.
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

/// Pictures whose coordinate system GDAL reads only from its own sidecar.
const PICTURES: [&str; 3] = ["png", "pgm", "exr"];
