//! A map of tiles.

use orogen::recipe::outputs::CLASS;
use orogen::tilemap::TilemapJob;
use orogen::world::HEIGHT;
use orogen::{Result, WorldSpec};

use super::command_line::CommandLine;
use super::given::{self, Given};
use super::samples::Samples;
use super::work::{Work, lines};
use crate::preview::region::Region;

/// The settings of an export of a tilemap.
#[derive(Debug, Clone)]
pub struct TilemapExport {
    /// Cells along the longer side.
    pub size: usize,
    /// The options of [`TilemapJob::OPTIONS`].
    pub options: Given,
}

impl Default for TilemapExport {
    fn default() -> TilemapExport {
        TilemapExport { size: TilemapJob::SIDE, options: Given::new() }
    }
}

impl TilemapExport {
    fn samples(&self, region: Region, world: &WorldSpec) -> Samples {
        Samples::of(region, Some(self.size), world)
    }

    /// Adds the options of `orogen tilemap`.
    pub fn words(&self, region: Region, world: &WorldSpec, line: &mut CommandLine) {
        match self.samples(region, world) {
            Samples::Fitting(TilemapJob::SIDE) => {}
            samples => samples.sized(line),
        }
        given::words(TilemapJob::OPTIONS, &self.options, line);
    }

    /// Writes the files. Returns a description.
    ///
    /// # Errors
    /// If there is no such tileset, or the export fails; then existing files are unchanged.
    pub fn make(&self, mut work: Work, region: Region) -> Result<String> {
        let job = TilemapJob::with_options(&given::read(TilemapJob::OPTIONS, &self.options)?)?;
        work.inputs.extend(job.files.iter().cloned());
        let layer = if work.recipe.outputs().any(|name| name == CLASS) { CLASS } else { HEIGHT };
        // The classes of a recipe without its own classes depend on the cell of the map.
        let window = self.samples(region, &work.recipe.world).window(&work.open()?)?;
        job.prepare(&mut work.recipe, window.cell)?;
        let world = work.open()?;
        let written = job.to_folder(&world, &window, layer, (&work.path, &work.policy()), work.progress)?;
        // The dialog already shows the folder.
        let (words, folder) = (written.words(), format!("{}: ", work.path.display()));
        Ok(lines(words.strip_prefix(&folder).unwrap_or(&words), written.warning))
    }
}
