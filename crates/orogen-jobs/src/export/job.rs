//! An export as one job: what to export, in which format, and where to.

use std::io::{self, Write};
use std::path::Path;

use super::derived::list;
use super::format::Format;
use super::layer_source::LayerSource;
pub use super::run::Written;
use super::{features, mesh_cover, registry, run};
use crate::options::Options;
use orogen_engine::recipe::document::Recipe;
use orogen_engine::world::{HEIGHT, World};
use orogen_grid::error::Result;
use orogen_grid::grid::Window;
use orogen_grid::progress::Progress;
use orogen_io::file::Output;

/// The export of a layer over a window in a format.
///
/// [`prepare`](ExportJob::prepare) a recipe, open its world, then write [to a file](ExportJob::to_file) or [to a
/// stream](ExportJob::to_stream).
#[derive(Debug, Clone)]
#[non_exhaustive]
#[must_use]
pub struct ExportJob {
    /// The file format.
    pub format: &'static Format,
    /// The layer: an output of the recipe, `node.layer`, a layer [derived](super::derived) from the heights, or the
    /// names of layers of vector features, separated by commas. `height` by default.
    pub layer: String,
    /// The window; by default the whole world at its own cell, which must then be bounded.
    pub window: Option<Window>,
    /// Options of the format; none by default.
    pub options: Options,
    /// Options of the derived layer; none by default.
    pub layer_options: Options,
}

impl ExportJob {
    /// An export of the heights of the whole world, without options.
    pub fn new(format: &'static Format) -> ExportJob {
        ExportJob {
            format,
            layer: HEIGHT.into(),
            window: None,
            options: Options::default(),
            layer_options: Options::default(),
        }
    }

    /// Sets the layer.
    pub fn with_layer(self, layer: impl Into<String>) -> ExportJob {
        ExportJob { layer: layer.into(), ..self }
    }

    /// Sets the window.
    pub fn with_window(self, window: Window) -> ExportJob {
        ExportJob { window: Some(window), ..self }
    }

    /// Sets the options of the format.
    pub fn with_options(self, options: Options) -> ExportJob {
        ExportJob { options, ..self }
    }

    /// Sets the options of the derived layer.
    pub fn with_layer_options(self, layer_options: Options) -> ExportJob {
        ExportJob { layer_options, ..self }
    }

    /// Checks that the format has all given options.
    ///
    /// # Errors
    /// If it does not have one of them: the message names the formats that do.
    pub fn check(&self) -> Result<()> {
        registry::check(self.format, &self.options)
    }

    /// The files that the options name as inputs.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        self.options.files().chain(self.layer_options.files())
    }

    /// Appends to a recipe the nodes that the job needs; call it before the world is opened. Layers of the recipe
    /// itself need none.
    ///
    /// # Errors
    /// The errors of [`check`](ExportJob::check) and of [`list::prepare`].
    pub fn prepare(&self, recipe: &mut Recipe) -> Result<()> {
        self.check()?;
        // Vector features take precedence over a derived layer of the same name.
        match features::list::listed(&self.layer) {
            Some(_) if self.format.features => list::check(&self.layer, &[], &self.layer_options)?,
            _ => list::prepare(recipe, &self.layer, &self.layer_options)?,
        }
        mesh_cover::prepare(recipe, &self.options);
        Ok(())
    }

    /// Exports to a file and its sidecars, atomically.
    ///
    /// # Errors
    /// If the world has no such layer or cannot make the window, the format does not have an option or cannot hold the
    /// layer, no sample is finite, memory does not suffice (then no work was started), the work was cancelled, or a
    /// file cannot be written.
    pub fn to_file(&self, world: &World, output: &Output, progress: &Progress) -> Result<Written> {
        run::to_file(self.format, self.source(world, progress)?, &self.options, output)
    }

    /// Exports to a stream, without sidecars.
    ///
    /// # Errors
    /// The errors of [`to_file`](ExportJob::to_file); errors of the stream itself are returned unchanged.
    pub fn to_stream(&self, world: &World, out: &mut dyn Write, progress: &Progress) -> io::Result<Written> {
        run::to_stream(self.format, self.source(world, progress)?, &self.options, out)
    }

    /// The source of the export.
    fn source<'w>(&self, world: &'w World, progress: &Progress) -> Result<LayerSource<'w>> {
        let window = match self.window {
            Some(window) => window,
            None => world.full_window(world.recipe().world.cell)?,
        };
        run::source(self.format, world, &self.layer, window, progress)
    }
}
