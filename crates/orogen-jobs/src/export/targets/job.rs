//! An export for an engine as one job.

use std::path::PathBuf;

use super::frame::{Frame, FrameSpec, MAX_TILES};
use super::list as targets;
use super::target::EngineTarget;
use crate::export::channels::PREVIEW;
use crate::export::derived::list;
use crate::export::format::Format;
use crate::export::job::ExportJob;
use crate::export::{features, registry};
use crate::options::Condition::Given;
use crate::options::{OptionSpec, Options, ValueKind};
use orogen_engine::recipe::document::Recipe;
use orogen_engine::view::View;
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

const HEADING: &str = "Engines";

const OPTIONS: &[OptionSpec] = &[
    OptionSpec::new("target", "ENGINE", ValueKind::Choice(&targets::CHOICES))
        .with_about(
            "Game engine to write for: sets format, scale, row order and sizes, and prints the settings for its import \
             dialog. --size is the number of samples along each side, of each tile if there are several [default: as \
             many as the world has]",
        )
        .without(&["format"])
        .under(HEADING),
    OptionSpec::new("tiles", "NxM", ValueKind::Size(MAX_TILES))
        .with_about(
            "Number of tiles for the engine, east and south; adjacent tiles share the samples along their common edge",
        )
        .when(Given("target"))
        .under(HEADING),
];

impl EngineJob {
    /// The options, for front ends.
    pub const OPTIONS: &[OptionSpec] = OPTIONS;

    /// The export of the layer of another job for the engine that is chosen by [`OPTIONS`](EngineJob::OPTIONS), of the
    /// samples that a view of a world of `recipe` selects; `None` if no engine is chosen.
    ///
    /// # Errors
    /// If an option does not apply, or the errors of [`FrameSpec::of_view`] and [`check`](EngineJob::check).
    pub fn chosen(export: &ExportJob, options: &Options, view: &View, recipe: &Recipe) -> Result<Option<EngineJob>> {
        options.check(OPTIONS)?;
        let Some(target) = options.word("target").and_then(targets::named) else { return Ok(None) };
        let mut samples = FrameSpec::of_view(view, target, recipe)?;
        samples.tiles = match options.numbers("tiles") {
            Some(&[across, down]) => Some([across as usize, down as usize]),
            Some(&[count]) => Some([count as usize; 2]),
            _ => None,
        };
        let job = EngineJob::new(target, export.format)
            .with_layer(&export.layer)
            .with_options(export.options.clone())
            .with_layer_options(export.layer_options.clone())
            .with_samples(samples);
        job.check()?;
        Ok(Some(job))
    }

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

#[cfg(test)]
mod tests {
    use super::*;

    /// The job for these options and a view of 33 samples, of the slope with a preview or with a first row.
    fn chosen(given: &[(&str, &str)], format_option: &str) -> std::result::Result<Option<EngineJob>, String> {
        let text = "orogen = 1\n[world]\nsize = [640, 640]\n[nodes.a]\nop = \"constant\"\n[outputs]\nheight = \"a\"\n";
        let recipe = Recipe::parse(text, "test").unwrap();
        let view = View { size: Some("33".parse().unwrap()), ..View::default() };
        let specs = registry::options().into_iter().map(|(spec, _)| spec);
        let value = if format_option == "first-row" { "north" } else { "" };
        let of_format = Options::of(specs, [(format_option, value)]).unwrap();
        let format = registry::named("png").unwrap();
        let export = ExportJob::new(format).with_layer("slope").with_options(of_format);
        let options = Options::of(OPTIONS, given.iter().copied());
        options
            .and_then(|options| EngineJob::chosen(&export, &options, &view, &recipe))
            .map_err(|error| error.to_string())
    }

    #[test]
    fn an_engine_takes_the_layer_and_the_samples() {
        assert!(chosen(&[], "preview").unwrap().is_none());
        let job = chosen(&[("target", "unity")], "preview").unwrap().unwrap();
        assert_eq!((job.target.name, job.format.name, job.layer.as_str()), ("unity", "png", "slope"));
        assert!(job.options.has("preview") && job.samples == FrameSpec::default().with_side(33));
        for (text, tiles) in [("2x1", [2, 1]), ("3", [3, 3]), ("100 \u{d7} 1", [100, 1])] {
            let job = chosen(&[("target", "unity"), ("tiles", text)], "preview").unwrap().unwrap();
            assert_eq!(job.samples.tiles, Some(tiles), "{text}");
        }
    }

    #[test]
    fn what_an_engine_does_not_take_is_a_sentence() {
        for (given, option, expect) in [
            (&[("tiles", "2x2")][..], "preview", "--tiles needs --target"),
            (&[("target", "cryengine")], "preview", "it must be unreal, unity, terrain3d or hterrain"),
            (&[("target", "unity"), ("tiles", "0x2")], "preview", "N or WxH, such as 2x2, with sides from 1 to 100"),
            (&[("target", "unity"), ("tiles", "101")], "preview", "N or WxH, such as 2x2, with sides from 1 to 100"),
            (&[("target", "unity")], "first-row", "--target unity sets --first-row; leave it out"),
        ] {
            let why = chosen(given, option).unwrap_err();
            assert!(why.contains(expect), "{why}");
        }
    }
}
