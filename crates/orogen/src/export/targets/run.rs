//! An export for an engine.

use std::path::{Path, PathBuf};

use super::frame::Frame;
use super::target::Target;
use crate::error::{Error, ErrorKind, Result};
use crate::export::channels::{NORMAL, WEIGHTS, suffixed};
use crate::export::derived::layer::Nature;
use crate::export::files::Files;
use crate::export::format::Format;
use crate::export::options::Options;
use crate::export::run;
use crate::export::spread::BITS;
use crate::export::subject::Subject;
use crate::file;
use crate::grid::Window;
use crate::progress::Progress;
use crate::world::{HEIGHT, World};

/// What was made.
pub struct Exported {
    /// The files that were asked for.
    pub files: Vec<PathBuf>,
    /// Samples of all of them, east and south, each shared edge once.
    pub samples: [usize; 2],
    /// What the samples in them stand for.
    pub words: String,
    /// What to type into the engine's import dialogue, a line each; nothing for layers other than the heights.
    pub import: Vec<String>,
}

/// Exports a layer over a frame, all tiles of it or none. Heights and their scale are the target's own; weights and normals have its way; other layers are
/// grey pictures of 8 bits.
///
/// # Errors
/// If the format is none of the target's, or as [`run::to_file`].
pub fn export(
    target: &Target,
    format: &Format,
    frame: &Frame,
    world: &World,
    layer: &str,
    progress: &Progress,
    path: &Path,
) -> Result<Exported> {
    let mut options = Options::default();
    let subject = |window: Window| Subject::new(world, layer, window, progress);
    let mut all = subject(frame.window)?;
    let nature = all.nature();
    let known: &[&str] = if layer == HEIGHT { target.formats } else { &["png"] };
    if !known.contains(&format.name) {
        let list: Vec<String> = known.iter().map(|name| format!(".{name}")).collect();
        let sentence = format!("{} takes `{layer}` as {}, not as .{}", target.name, list.join(" or "), format.name);
        return Err(Error::new(ErrorKind::Request, sentence));
    }
    let mut import = Vec::new();
    let mut less = 0;
    match nature {
        // One scale for all tiles: the whole range is known before the first is written.
        Nature::Numbers if layer == HEIGHT => {
            all.rows(|_| Ok(())).map_err(|cause| file::explain("make", path, &cause))?;
            let levels = all.levels();
            (target.heights)(&levels, &mut options)?;
            import = (target.import)(frame.side, frame.window.cell, &levels);
        }
        Nature::Numbers => options.give(&BITS, "8")?,
        Nature::Normal => options.give(&NORMAL, target.normal)?,
        Nature::Weights => {
            options.give(&WEIGHTS, target.weights)?;
            less = target.weights_less;
        }
    }
    let (mut files, mut written, mut words) = (Vec::new(), Vec::new(), String::new());
    for row in 0..frame.tiles[1] {
        for column in 0..frame.tiles[0] {
            let path = match target.tile {
                Some(name) if frame.tiles != [1, 1] => suffixed(path, &name(column, row, frame.tiles[1])),
                _ => path.to_path_buf(),
            };
            let tile = frame.tile(column, row);
            let window = Window { width: tile.width - less, height: tile.height - less, ..tile };
            let (made, told) = run::staged(format, subject(window)?, &options, &path)?;
            words = told;
            written.push(made);
            files.push(path);
        }
    }
    written.into_iter().try_for_each(Files::commit).map_err(|cause| file::explain("write", path, &cause))?;
    let samples = [frame.window.width - less, frame.window.height - less];
    Ok(Exported { files, samples, words, import })
}
