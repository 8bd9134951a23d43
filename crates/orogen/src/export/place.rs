//! Where a raster lies on its map, beside formats that cannot say so: a world file and a `.prj`, and GDAL's own notes beside those pictures that it opens.

use std::io;
use std::path::{Path, PathBuf};

use super::files::Files;
use super::options::Options;
use super::sidecar::{self, Held, NO_SIDECAR};
use super::subject::Subject;
use crate::error::{Error, ErrorKind};
use crate::format::dem::Georeference;
use crate::format::{aux_xml, world_file};
use crate::grid::Window;
use crate::open;

/// More bytes than any file that tells a place has.
const LONGEST: u64 = 1 << 20;

/// Writes both beside the file that was asked for, or the `.prj` alone where the format tells its place itself; returns the words that tell of it.
/// Nothing is written of a world that lies on no map, beside a stream, and with `--no-sidecar`.
///
/// Fails as the files do, and if a file of that name lies there that tells another place.
pub fn write(files: &mut Files, subject: &Subject, options: &Options, from_south: Option<bool>) -> io::Result<String> {
    let Some(path) = files.path().map(Path::to_path_buf) else { return Ok(String::new()) };
    write_for(files, &path, subject, options, from_south)
}

/// Writes NAME.json and the location, of a format whose files tell everything but where they lie: only for a world that lies on a map.
///
/// Fails as [`write`] and [`sidecar::write`].
pub fn write_on_map(
    files: &mut Files,
    subject: &Subject,
    options: &Options,
    sample: &'static str,
) -> io::Result<String> {
    if subject.map().is_none() {
        return Ok(String::new());
    }
    let told = sidecar::write(files, subject, options, &Held { sample, ..Held::default() })?;
    Ok(told + &write(files, subject, options, Some(false))?)
}

/// As [`write`], of one of several files.
///
/// Fails as [`write`].
pub fn write_for(
    files: &mut Files,
    path: &Path,
    subject: &Subject,
    options: &Options,
    from_south: Option<bool>,
) -> io::Result<String> {
    let Some(map) = subject.map() else { return Ok(String::new()) };
    if options.has(NO_SIDECAR.name) || files.path().is_some_and(|path| path.exists() && !path.is_file()) {
        return Ok(String::new());
    }
    let (all, lacking) = companions(path, &map, subject.window(), from_south)?;
    let mut written = Vec::new();
    for Companion { path: to, bytes, shared } in all {
        // It tells the place of every file NAME, whatever its ending: of one that is there and is not written anew, too.
        let kept = shared && !files.replaces_all();
        if kept
            && to.exists()
            && !path.exists()
            && open::bytes(&to, "read", LONGEST).is_ok_and(|old| old.is_none_or(|old| old != bytes))
        {
            let sentence = format!(
                "cannot write {}: {} is there and gives another location, with which it would be read; write to another name, or say --{} or --force",
                path.display(),
                to.display(),
                NO_SIDECAR.name
            );
            return Err(Error::new(ErrorKind::File, sentence).into());
        }
        written.push(to.file_name().unwrap_or_default().to_string_lossy().into_owned());
        files.write_beside(|_| to, |out| out.write_all(&bytes))?;
    }
    let where_it_lies = match written.as_slice() {
        [] => String::new(),
        [one] => format!("; {one} tells where it lies"),
        [init @ .., last] => format!("; {} and {last} tell where it lies", init.join(", ")),
    };
    Ok(match lacking {
        Some(why) => format!("{where_it_lies}; its coordinate system is not told: {why}"),
        None => where_it_lies,
    })
}

/// A file that tells where another one lies.
pub struct Companion {
    /// Where it belongs.
    pub path: PathBuf,
    /// What is in it.
    pub bytes: Vec<u8>,
    /// Whether it speaks for every file of that name, whatever its ending.
    pub shared: bool,
}

/// What stands beside a raster of a window: a world file where `from_south` says which row is its first, a `.prj`, and beside the pictures that it opens
/// GDAL's own notes. Also, why the coordinate system could not be told.
///
/// Fails never: what is written goes to memory.
pub fn companions(
    path: &Path,
    map: &Georeference,
    window: &Window,
    from_south: Option<bool>,
) -> io::Result<(Vec<Companion>, Option<String>)> {
    let wkt = map.wkt();
    let mut all = Vec::new();
    if let Some(from_south) = from_south {
        let affine = map.affine(window, from_south);
        let mut bytes = Vec::new();
        world_file::write(&mut bytes, &affine)?;
        all.push(Companion { path: world_file::beside(path), bytes, shared: true });
        let extension = path.extension().unwrap_or_default();
        if let (true, Ok(wkt)) = (PICTURES.iter().any(|own| extension.eq_ignore_ascii_case(own)), &wkt) {
            let mut bytes = Vec::new();
            aux_xml::write(&mut bytes, &affine, wkt)?;
            // It is this file's alone, and GDAL writes it anew without asking.
            all.push(Companion { path: crate::format::sidecar::aux_xml(path), bytes, shared: false });
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
