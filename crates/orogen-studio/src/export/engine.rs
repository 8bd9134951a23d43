//! A layer for a game engine.

use std::path::Path;

use orogen::export::registry;
use orogen::export::targets::frame::FrameSpec;
use orogen::export::targets::job::EngineJob;
use orogen::export::targets::list;
use orogen::export::targets::target::EngineTarget;
use orogen::grid::words::number;
use orogen::world::HEIGHT;
use orogen::{Result, Window, WorldSpec};

use super::command_line::CommandLine;
use super::layer::ending;
use super::samples::part;
use super::work::{Work, lines};
use crate::preview::region::Region;

/// The settings of an export for a game engine.
#[derive(Debug, Clone)]
pub struct EngineExport {
    /// The engine.
    pub target: &'static EngineTarget,
    /// The layer.
    pub layer: String,
    /// Number of samples along a side, of each tile if there are several; `None` for as many as the world has.
    pub side: Option<usize>,
    /// Number of tiles, east and south.
    pub tiles: [usize; 2],
}

impl EngineExport {
    /// An export of the heights for the first engine.
    #[must_use]
    pub fn new() -> Option<EngineExport> {
        let target = list::all().first().copied()?;
        Some(EngineExport { target, layer: HEIGHT.into(), side: None, tiles: [1, 1] })
    }

    /// Selects another engine; settings that it does not support are reset.
    pub fn set_target(&mut self, target: &'static EngineTarget) {
        self.target = target;
        self.side = self.side.filter(|side| target.sides.contains(side));
        if self.formats().is_empty() {
            self.layer = HEIGHT.into();
        }
        if target.tile.is_none() {
            self.tiles = [1, 1];
        }
    }

    /// The formats from which the engine imports this layer.
    #[must_use]
    pub fn formats(&self) -> &'static [&'static str] {
        self.target.formats_of(&self.layer)
    }

    /// The samples. A part of the world starts at its corner; its cell is chosen so that the engine's number of samples
    /// fills it.
    fn samples(&self, region: Region, world: &WorldSpec) -> FrameSpec {
        let mut samples = FrameSpec::default();
        if self.tiles != [1, 1] {
            samples = samples.with_tiles(self.tiles);
        }
        if let Some([west, north, side]) = region.square(world.size) {
            let most = self.tiles[0].max(self.tiles[1]).max(1);
            let there = (side / world.cell / most as f64) as usize + 1;
            let own = self.target.sides.iter().copied().filter(|side| *side <= there).max();
            let chosen = self.side.or(own).or(self.target.sides.first().copied()).unwrap_or(there);
            let cell = side / (most * (chosen - 1)).max(1) as f64;
            let [x, y] = [west, north].map(|first| (first / cell).floor() as i64);
            let [width, height] = self.tiles.map(|tiles| tiles * (chosen - 1) + 1);
            return samples.with_side(chosen).with_cell(cell).with_window(Window { x, y, width, height, cell });
        }
        self.side.map_or(samples, |side| samples.with_side(side))
    }

    /// Adds the options of `orogen export`.
    pub fn words(&self, region: Region, world: &WorldSpec, line: &mut CommandLine) {
        line.option("target", self.target.name);
        line.differing("layer", self.layer.as_str(), &HEIGHT);
        let samples = self.samples(region, world);
        if let Some(side) = samples.side {
            line.option("size", side);
        }
        if let Some([east, south]) = samples.tiles {
            line.option("tiles", format!("{east}x{south}"));
        }
        if let Some(window) = samples.window {
            part(&window, line);
        }
    }

    /// Writes the files. Returns a description with the values for the engine's import dialog.
    ///
    /// # Errors
    /// If the engine does not support the settings, or the export fails; then existing files are unchanged.
    pub fn make(&self, mut work: Work, region: Region) -> Result<String> {
        let format = format_of(&work.path, self.formats())?;
        let job = EngineJob::new(self.target, format)
            .with_layer(&self.layer)
            .with_samples(self.samples(region, &work.recipe.world));
        job.prepare(&mut work.recipe)?;
        let world = work.open()?;
        let made = job.run(&world, &work.output()?, work.progress)?;
        let warning = made.count.check(&format!("the layer `{}`", self.layer))?;
        let [width, height] = made.samples;
        let words = format!("{width} x {height} samples of {} m, {}", number(made.frame.window.cell), made.words);
        Ok(lines(&words, warning.into_iter().chain(made.frame.note).chain(made.import)))
    }
}

/// The format of a file, which must be one of these names.
fn format_of(path: &Path, names: &[&str]) -> Result<&'static orogen::export::Format> {
    let format = registry::of_path(path)?;
    match names.contains(&format.name) {
        true => Ok(format),
        false => Err(ending(path, "the engine's file", names)),
    }
}
