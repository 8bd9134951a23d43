//! The files of `orogen generate`.

use std::io::Write;
use std::path::Path;

use orogen::export::place;
use orogen::grid::analysis::{Summary, summary};
use orogen::io::file::{self, Output, OutputPolicy, Staged, mark};
use orogen::io::format::levels::Levels;
use orogen::io::format::{Georeference, notes, png};
use orogen::output::map::Painter;
use orogen::{Grid, Recipe, Result, Window};
use serde::Serialize;

use crate::interrupt::Stoppable;
use crate::say;

/// `summary.json`. Keys have the order of the fields.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    /// The program and its version.
    pub made_by: String,
    /// The world's seed.
    pub seed: u64,
    /// Samples per row.
    pub width: usize,
    /// Number of rows.
    pub height: usize,
    /// Distance between samples, in metres.
    pub cell: f64,
    /// Minimum height in metres, which is 0 in `height.png`.
    pub height_min: f32,
    /// Maximum height in metres, which is 65535 in `height.png`.
    pub height_max: f32,
    /// Mean height in metres.
    pub height_mean: f64,
    /// Sea level in metres.
    pub sea_level: f64,
    /// Share of the samples above sea level, 0 to 1.
    pub land_share: f64,
    /// Duration of the command, in seconds.
    pub seconds: f64,
    /// SHA-256 of the heights as f32 little-endian, row-major.
    pub sha256: String,
    /// The transform from columns and rows to map coordinates, in GDAL's order, for a world on a map.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub geotransform: Option<[f64; 6]>,
    /// The EPSG code of the map's coordinate system.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub crs: Option<String>,
    /// The map's coordinate system as well-known text.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wkt: Option<String>,
}

impl Report {
    /// The text of `summary.json`.
    pub fn json(&self) -> String {
        // A struct of numbers and strings can always be serialized.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }
}

/// The file names in the order in which the files are put in place: the summary is last, so its presence means that all
/// files are complete.
pub const FILES: [&str; 5] = ["height.png", "height8.png", "map.png", "recipe.toml", "summary.json"];

/// The outputs in `folder`; fails if existing files may not be replaced.
pub fn outputs(folder: &Path, policy: &OutputPolicy) -> Result<Vec<Output>> {
    FILES.iter().map(|name| policy.output(folder.join(name))).collect()
}

/// Writes either all files to their `outputs`, or none: they are put in place only after all are written to disk. The
/// map shows `lakes`, their depth in metres. `seconds` returns the duration of the command.
pub fn write(
    outputs: &[Output],
    recipe: &Recipe,
    grid: &Grid,
    lakes: Option<&Grid>,
    seconds: impl FnOnce() -> f64,
) -> Result<Report> {
    let levels = Levels::of(grid);
    let notes = notes::of_heights(grid.window().cell, &levels);
    let notes: Vec<(&str, &str)> = notes.iter().map(|(keyword, text)| (*keyword, text.as_str())).collect();
    let stage = |nth: usize, body: &(dyn Fn(&mut dyn Write) -> std::io::Result<()> + Sync)| {
        file::stage(&outputs[nth], |out| body(&mut Stoppable(out)))
    };
    let (pictures, summary) = rayon::join(
        || {
            rayon::join(
                || stage(2, &|out| Painter::fit(grid, recipe.world.sea_level).write_png(out, grid, lakes, &notes[..1])),
                || {
                    let grey16 = stage(0, &|out| png::write_grey16(out, grid, &levels, &notes))?;
                    let grey8 = stage(1, &|out| png::write_grey8(out, grid, &levels, &notes))?;
                    Ok::<[Staged; 2], orogen::Error>([grey16, grey8])
                },
            )
        },
        || summary(grid.data(), recipe.world.sea_level),
    );
    let (map, greys) = (pictures.0?, pictures.1?);
    let places = places(&outputs[..3], recipe, grid.window())?;
    let text = stage(3, &|out| out.write_all(mark::marked(&(again(recipe, grid) + &recipe.to_toml())).as_bytes()))?;
    let report = report(recipe, grid, summary, seconds());
    let json = stage(4, &|out| out.write_all(report.json().as_bytes()))?;
    file::commit(places.into_iter().chain(greys).chain([map, text, json]).collect())?;
    Ok(report)
}

/// Sidecars with the georeferencing of the pictures, if the world has one: a world file, a `.prj` and GDAL's `.aux.xml`
/// for each.
fn places(pictures: &[Output], recipe: &Recipe, window: &Window) -> Result<Vec<Staged>> {
    let Some(map) = recipe.georeference() else { return Ok(Vec::new()) };
    let mut staged = Vec::new();
    for picture in pictures {
        staged.extend(place::stage(picture, &map, map.affine(window, false))?);
    }
    Ok(staged)
}

/// The comment at the top of the recipe: the command line that reproduces the output.
fn again(recipe: &Recipe, grid: &Grid) -> String {
    let (width, height, cell) = (grid.width(), grid.height(), grid.window().cell);
    // The default view of an unbounded world is at its own cell and has a fixed size.
    let view = match recipe.world.size {
        None if cell == recipe.world.cell => format!("--size {width}x{height}"),
        _ => format!("--cell {cell}"),
    };
    let version = env!("CARGO_PKG_VERSION");
    format!(
        "# Orogen {version} made the files beside this one, {width} x {height} samples: orogen generate {} {view}\n",
        FILES[3]
    )
}

fn report(recipe: &Recipe, grid: &Grid, summary: Summary, seconds: f64) -> Report {
    let map = recipe.georeference();
    Report {
        made_by: say::SOFTWARE.into(),
        seed: recipe.world.seed,
        width: grid.width(),
        height: grid.height(),
        cell: grid.window().cell,
        height_min: summary.min,
        height_max: summary.max,
        height_mean: summary.mean,
        sea_level: recipe.world.sea_level,
        land_share: summary.land_share,
        seconds: (seconds * 1000.0).round() / 1000.0,
        sha256: summary.sha256,
        geotransform: map.as_ref().map(|map| map.affine(grid.window(), false).geotransform()),
        crs: map.as_ref().and_then(Georeference::epsg).map(|code| format!("EPSG:{code}")),
        wkt: map.as_ref().and_then(|map| map.wkt().ok()),
    }
}
