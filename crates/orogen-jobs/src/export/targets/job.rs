//! An export for an engine as one job.

use std::path::PathBuf;

use super::frame::{Frame, FrameSpec};
use super::target::EngineTarget;
use crate::export::channels::PREVIEW;
use crate::export::derived::list;
use crate::export::format::Format;
use crate::export::{features, registry};
use crate::options::Options;
use orogen_engine::recipe::document::Recipe;
use orogen_engine::world::HEIGHT;
use orogen_grid::analysis::finite::FiniteCount;
use orogen_grid::error::{Error, ErrorKind, Result};

/// The export of a layer for an engine, in one file or in tiles. The engine sets the options of the format.
///
/// [`prepare`](EngineJob::prepare) a recipe, open its world, then [`run`](EngineJob::run).
#[derive(Debug, Clone)]
#[non_exhaustive]
#[must_use]
pub struct EngineJob {
    /// The engine.
    pub target: &'static EngineTarget,
    /// The file format, which the engine must support for the layer.
    pub format: &'static Format,
    /// The layer: an output of the recipe, `node.layer`, a layer [derived](crate::export::derived) from the heights, or
    /// `scatter`. `height` by default.
    pub layer: String,
    /// Options of the derived layer; none by default.
    pub layer_options: Options,
    /// Options of the format that no engine sets, which are [`PREVIEW`] alone; none by default.
    pub options: Options,
    /// The requested samples; by default the engine chooses them.
    pub samples: FrameSpec,
}

impl EngineJob {
    /// The heights of the whole world.
    pub fn new(target: &'static EngineTarget, format: &'static Format) -> EngineJob {
        EngineJob {
            target,
            format,
            layer: HEIGHT.into(),
            layer_options: Options::default(),
            options: Options::default(),
            samples: FrameSpec::default(),
        }
    }

    /// The same for this layer.
    pub fn with_layer(self, layer: impl Into<String>) -> EngineJob {
        EngineJob { layer: layer.into(), ..self }
    }

    /// The same with these options of the derived layer.
    pub fn with_layer_options(self, layer_options: Options) -> EngineJob {
        EngineJob { layer_options, ..self }
    }

    /// The same with these options of the format.
    pub fn with_options(self, options: Options) -> EngineJob {
        EngineJob { options, ..self }
    }

    /// The same with these samples.
    pub fn with_samples(self, samples: FrameSpec) -> EngineJob {
        EngineJob { samples, ..self }
    }

    /// Checks that its options are among those that no engine sets, and that the format has them.
    ///
    /// # Errors
    /// If one is not.
    pub fn check(&self) -> Result<()> {
        registry::check(self.format, &self.options)?;
        match self.options.names().find(|name| *name != PREVIEW.name) {
            None => Ok(()),
            Some(option) => {
                let message = format!("--target {} sets --{option}; leave it out", self.target.name);
                Err(Error::new(ErrorKind::Request, message))
            }
        }
    }

    /// Appends to a recipe the nodes that the layer needs; call it before the world is opened.
    ///
    /// # Errors
    /// The errors of [`list::prepare`].
    pub fn prepare(&self, recipe: &mut Recipe) -> Result<()> {
        match features::list::listed(&self.layer) {
            Some(_) if self.format.features => list::check(&self.layer, &[], &self.layer_options),
            _ => list::prepare(recipe, &self.layer, &self.layer_options),
        }
    }
}

/// The result of an export for an engine.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Exported {
    /// The samples of the export.
    pub frame: Frame,
    /// The main files.
    pub files: Vec<PathBuf>,
    /// Number of samples east and south, with each shared edge counted once.
    pub samples: [usize; 2],
    /// A description of the samples.
    pub words: String,
    /// The count of samples; shared edges count in each tile.
    pub count: FiniteCount,
    /// Values for the engine's import dialog, one line each; empty for layers other than the heights.
    pub import: Vec<String>,
}
