//! A map sheet.

use std::path::Path;

use orogen::export::derived::list as derived;
use orogen::jobs::{MapJob, SheetFormat};
use orogen::recipe::Recipe;
use orogen::{Result, WorldSpec};

use super::command_line::CommandLine;
use super::given::{self, Given};
use super::samples::Samples;
use super::work::{Work, lines};
use crate::preview::region::Region;

/// The settings of an export of a map sheet.
#[derive(Debug, Clone)]
pub struct MapExport {
    /// The kind of file.
    pub format: SheetFormat,
    /// Number of samples along the longer side; `None` for the world's own cell.
    pub samples: Option<usize>,
    /// The options of [`MapJob::OPTIONS`].
    pub options: Given,
    /// The default heading of the command.
    pub own_title: String,
    /// Whether the world is a file of heights.
    pub is_place: bool,
}

impl MapExport {
    /// An export as a picture of the heights.
    #[must_use]
    pub fn new(title: &str, is_place: bool) -> MapExport {
        MapExport { format: SheetFormat::Png, samples: None, options: Given::new(), own_title: title.into(), is_place }
    }

    /// The layers of a recipe that a map can show: layers with one channel.
    #[must_use]
    pub fn layers(recipe: &Recipe) -> Vec<String> {
        let mut names: Vec<String> = recipe.outputs().map(str::to_owned).collect();
        for layer in derived::all().iter().filter(|layer| !layer.palette.is_empty()) {
            if !names.iter().any(|name| name == layer.name) {
                names.push(layer.name.to_owned());
            }
        }
        names
    }

    /// Adds the options of `orogen map`.
    pub fn words(&self, path: &Path, region: Region, world: &WorldSpec, line: &mut CommandLine) {
        if SheetFormat::of_path(path) != Some(self.format) {
            line.option("format", self.format.name());
        }
        given::words(MapJob::OPTIONS, &self.options, line);
        Samples::of(region, self.samples, world).unsized_for(world, line);
    }

    /// Writes the file. Returns a description.
    ///
    /// # Errors
    /// If options are not valid, or the export fails; then an existing file is unchanged.
    pub fn make(&self, mut work: Work, region: Region) -> Result<String> {
        let options = given::read(MapJob::OPTIONS, &self.options)?;
        let mut job = MapJob::new(self.format).with_title(&self.own_title).with_options(&options)?;
        job.is_place = self.is_place;
        job.prepare(&mut work.recipe)?;
        let world = work.open()?;
        let window = Samples::of(region, self.samples, &work.recipe.world).window(&world)?;
        let output = work.policy().protecting(options.files()).output(&work.path)?;
        let drawn = job.with_window(window).to_file(&world, &output, work.progress)?;
        let lacking: String = drawn.lacking().iter().collect();
        let letters = (!lacking.is_empty()).then(|| format!("no installed font has the letters {lacking}"));
        Ok(lines(&drawn.words(), drawn.warnings().iter().cloned().chain(letters)))
    }
}
