//! The options of variants of a recipe.

use super::render::{RenderJob, around};
use super::render_options::CAMERA;
use crate::options::Condition::Given;
use crate::options::{OptionSpec, Options, ValueKind};
use orogen_grid::error::Result;
use orogen_io::palette::palette::Palette;
use orogen_output::render::scene::Colors;

/// Pictures of one recipe side by side: of several seeds, or of values of a parameter.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct VariantsJob {
    /// Number of seeds.
    pub seeds: u64,
    /// The first seed, or that of all pictures; that of the recipe if there is none.
    pub seed: Option<u64>,
    /// The colors of heights.
    pub palette: Option<Palette>,
    /// The view in perspective, in place of a map.
    pub render: Option<RenderJob>,
    /// Samples along the longer side of each picture.
    pub size: usize,
    /// Pictures per row.
    pub columns: Option<usize>,
}

const OPTIONS: &[OptionSpec] = &[
    OptionSpec::new("seeds", "N", ValueKind::Whole(1, 64))
        .with_about("Number of seeds to show, starting with the recipe's seed or --seed [default: 9]")
        .without(&["sweep"]),
    OptionSpec::new("seed", "N", ValueKind::Whole(0, i64::MAX as u64))
        .with_about("The first seed, or with --sweep the seed of all pictures [default: the recipe's]"),
    OptionSpec::new("palette", "NAME|FILE", ValueKind::Palette).with_about(
        "Palette: a name (`orogen palettes` lists them) or a file (.cpt, .gpl, .toml, or gdaldem) [default: \
         hypsometric]",
    ),
    OptionSpec::switch("nearest-color")
        .with_about(
            "Give each value the color of the nearest stop of the palette, without mixing (as gdaldem's \
             -nearest_color_entry)",
        )
        .when(Given("palette")),
    OptionSpec::switch("render").with_about(
        "Show the land in perspective, as `orogen render` does, instead of a map; with --palette in the colors of the \
         map, over the heights of all pictures",
    ),
    OptionSpec::new("camera", "A,E[,D]", ValueKind::Tuple(CAMERA, 2))
        .with_about(
            "Camera position around the center of the land, as in `orogen render`: AZIMUTH,ELEVATION[,DISTANCE] \
             [default: 200,24]",
        )
        .when(Given("render")),
    OptionSpec::new("size", "N", ValueKind::Whole(64, 2048))
        .with_about("Samples along the longer side of each picture")
        .with_default("320"),
    OptionSpec::new("columns", "N", ValueKind::Whole(1, 64))
        .with_about("Pictures per row [default: about the number of rows]"),
];

impl VariantsJob {
    /// The options, for front ends.
    pub const OPTIONS: &[OptionSpec] = OPTIONS;

    /// The pictures that are chosen by [`OPTIONS`](VariantsJob::OPTIONS).
    ///
    /// # Errors
    /// If a palette cannot be read, or the errors of [`RenderJob::check`].
    pub fn new(options: &Options) -> Result<VariantsJob> {
        let palette = options.palette()?;
        let size = options.whole("size").unwrap_or(320) as usize;
        let render = || -> Result<RenderJob> {
            let mut job = RenderJob { size: [size, size * 3 / 4], ..RenderJob::default() };
            if let Some(camera) = options.numbers("camera") {
                job.view = around(camera)?;
            }
            if palette.is_some() {
                (job.colors, job.palette) = (Colors::Map, palette.clone());
            }
            job.check()?;
            Ok(job)
        };
        Ok(VariantsJob {
            seeds: options.whole("seeds").unwrap_or(9),
            seed: options.whole("seed"),
            render: options.has("render").then(render).transpose()?,
            palette,
            size,
            columns: options.whole("columns").map(|columns| columns as usize),
        })
    }
}
