//! The making of a world from a map.

use std::path::Path;

use orogen_engine::session;
use orogen_grid::error::Result;
use orogen_grid::progress::Progress;
use orogen_grid::words::{count, number};
use orogen_io::file::OutputPolicy;
use orogen_io::format::fmg::FmgMap;

use super::calibration::{Calibration, calibrated};
use super::files;
use super::rasters::Rasters;
use super::recipe::Template;

/// The shares of the work: rasters, calibration.
const TIMES: [f64; 2] = [1.0, 9.0];

/// Memory for a site of the map, in bytes: positions and heights, and the samples of the rasters around it.
const SITE: u64 = 400;

/// A world from a map of Azgaar's Fantasy Map Generator.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct AuthorMapJob {
    /// Width of the world in kilometres; `None` for that of the map.
    pub width: Option<f64>,
    /// Seed of the world; `None` for that of the map.
    pub seed: Option<u64>,
}

/// A recipe and the files that it reads.
#[derive(Debug)]
#[non_exhaustive]
pub struct AuthorWorld {
    /// The map.
    pub map: FmgMap,
    pub(super) rasters: Rasters,
    pub(super) template: Template,
    pub(super) calibration: Calibration,
}

impl AuthorMapJob {
    /// A job with the map's own width and seed.
    #[must_use]
    pub fn new() -> AuthorMapJob {
        AuthorMapJob::default()
    }

    /// Sets the width of the world in kilometres.
    #[must_use]
    pub fn with_width(self, width: Option<f64>) -> AuthorMapJob {
        AuthorMapJob { width, ..self }
    }

    /// Sets the seed of the world.
    #[must_use]
    pub fn with_seed(self, seed: Option<u64>) -> AuthorMapJob {
        AuthorMapJob { seed, ..self }
    }

    /// Reads the map at `path` and makes a world of it. `folder` is the name of the folder of its files in the recipe.
    ///
    /// # Errors
    /// If the map cannot be read, memory does not suffice, or the work was cancelled.
    pub fn run(
        &self,
        path: &Path,
        folder: &str,
        limits: &session::Options,
        progress: &Progress,
    ) -> Result<AuthorWorld> {
        let map = FmgMap::read(path, self.width)?;
        self.run_on(map, folder, limits, progress)
    }

    /// Makes a world of a map.
    ///
    /// # Errors
    /// If memory does not suffice, or the work was cancelled.
    pub fn run_on(
        &self,
        map: FmgMap,
        folder: &str,
        limits: &session::Options,
        progress: &Progress,
    ) -> Result<AuthorWorld> {
        let _sites = limits.memory.reserve(SITE.saturating_mul((map.sites.len() + map.rain.len()) as u64))?;
        let [drawing, calibrating] = progress.parts(TIMES);
        let mut rasters = Rasters::new(&map, &drawing)?;
        let template = Template::new(&map, &rasters, folder, self.seed);
        let calibration = calibrated(&map, &mut rasters, &template, limits, &calibrating)?;
        Ok(AuthorWorld { map, rasters, template, calibration })
    }
}

impl AuthorWorld {
    /// The text of the recipe.
    #[must_use]
    pub fn recipe(&self) -> String {
        self.template.text(&self.map)
    }

    /// Writes the recipe to `recipe` and the files to `folder`: all of them, or none if one exists.
    ///
    /// # Errors
    /// If a file exists, or cannot be written.
    pub fn write(&self, recipe: &Path, folder: &Path, policy: &OutputPolicy) -> Result<()> {
        files::write((&self.map, &self.rasters, self.recipe()), recipe, folder, policy)
    }

    /// Correlation of the heights of the world with those of the map's cells.
    #[must_use]
    pub fn correlation(&self) -> f64 {
        self.calibration.correlation
    }

    /// A description: size, parts, and how well the heights follow the map.
    #[must_use]
    pub fn words(&self) -> String {
        let FmgMap { size, lakes, rivers, settlements, .. } = &self.map;
        let kilometres = |metres: f64| number((metres / 1000.0).round());
        let [finest, coarsest] = [self.template.finest(), self.template.coarsest()];
        let Calibration { correlation, ratio, .. } = self.calibration;
        format!(
            "{} x {} km, cells of the map {} km, levels from {} km to {} m\n{}, {}, {}\n\
             heights of the world at the map's cells: correlation {correlation:.2}, median ratio {ratio:.2}",
            kilometres(size[0]),
            kilometres(size[1]),
            number((self.map.spacing / 100.0).round() / 10.0),
            number(coarsest / 1000.0),
            number((finest * 100.0).round() / 100.0),
            count(rivers.len(), "river"),
            count(lakes.len(), "lake"),
            count(settlements.len(), "settlement"),
        )
    }
}
