//! Folders of block worlds, and what may be replaced in them.

use std::path::Path;

use super::blocks_format::BlockFormat;
use super::minecraft::{LEVEL, REGIONS, region_names};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;
use orogen_io::file::{Existing, Output, OutputFolder, OutputPolicy};
use orogen_io::fs;
use orogen_output::blocks::{luanti, minecraft};

/// The folder of a world of several files.
pub struct BlocksFolder {
    folder: OutputFolder,
    outputs: Vec<Output>,
}

impl BlocksFolder {
    /// The folder for the blocks of a window, with those around it.
    ///
    /// # Errors
    /// If a game has opened a world there, a file may not be replaced, or a folder cannot be made.
    pub fn new(format: BlockFormat, path: &Path, window: &Window, policy: &OutputPolicy) -> Result<BlocksFolder> {
        match format {
            BlockFormat::Minecraft => BlocksFolder::of_minecraft(path, window, policy),
            _ => BlocksFolder::of_luanti(path, policy),
        }
    }

    fn of_luanti(path: &Path, policy: &OutputPolicy) -> Result<BlocksFolder> {
        if policy.existing() != Existing::Replace && fs::is_present(&path.join(luanti::OPENED)) {
            let message = format!(
                "cannot write {}: Luanti has opened this world, so it may have been changed; choose another name, or \
                 replace its map with --force",
                path.display()
            );
            return Err(Error::new(ErrorKind::File, message));
        }
        let outputs = luanti::FILES.iter().map(|name| policy.output(path.join(name))).collect::<Result<_>>()?;
        let textures = path.join(luanti::FILES[0]);
        Ok(BlocksFolder { folder: OutputFolder::ready(textures.parent().unwrap_or(path))?, outputs })
    }

    fn of_minecraft(path: &Path, window: &Window, policy: &OutputPolicy) -> Result<BlocksFolder> {
        let regions = path.join(REGIONS);
        let names = region_names(window);
        if policy.existing() != Existing::Replace {
            let refuse = |why: &str| {
                let message = format!("cannot write {}: {why}", path.display());
                Err(Error::new(ErrorKind::File, message))
            };
            if minecraft::OPENED.iter().any(|name| fs::is_present(&path.join(name))) {
                return refuse(
                    "Minecraft has opened this save, so it may have been changed; choose another name, or replace its \
                     regions with --force",
                );
            }
            // Two worlds in one save would meet at a cliff.
            if has_other_regions(&regions, &names) {
                return refuse(
                    "it has regions outside of this window; choose another name, or add to the save with --force",
                );
            }
        }
        let paths = names.iter().map(|name| regions.join(name)).chain([path.join(LEVEL)]);
        let outputs = paths.map(|path| policy.output(path)).collect::<Result<_>>()?;
        Ok(BlocksFolder { folder: OutputFolder::ready(&regions)?, outputs })
    }

    /// The outputs, in the order in which they are put in place.
    pub(super) fn outputs(&self) -> &[Output] {
        &self.outputs
    }

    /// Keeps the folder.
    pub(super) fn keep(self) {
        self.folder.keep();
    }
}

/// Whether a folder has region files other than those with these names.
fn has_other_regions(folder: &Path, names: &[String]) -> bool {
    let Ok(entries) = fs::read_dir(folder) else { return false };
    entries.flatten().any(|entry| {
        let name = entry.file_name().to_string_lossy().into_owned();
        name.ends_with(".mca") && !names.contains(&name)
    })
}
