//! The files of a world: its recipe, and the folder of what the recipe reads.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Grid;
use orogen_io::file::{self, OutputFolder, OutputPolicy, Staged};
use orogen_io::format::features::{Crs, FeatureLayer};
use orogen_io::format::fmg::FmgMap;
use orogen_io::format::geotiff::{Options as Layout, writer};
use orogen_io::format::{csv, geojson};
use orogen_io::fs;
use orogen_io::spool::Spool;

use super::layers;
use super::rasters::Rasters;

/// The files in the folder.
pub const COAST: &str = "coast.geojson";
pub const LAKES: &str = "lakes.geojson";
pub const RIVERS: &str = "rivers.geojson";
pub const PLACES: &str = "places.csv";
pub const HEIGHTS: &str = "heights.tif";
pub const UPLIFT: &str = "uplift.tif";
pub const RAIN: &str = "rain.tif";

/// The resolution of coordinates, in metres: they are rounded to a thousandth of it.
const STEP: f64 = 100.0;

/// The content of a file.
enum Content<'a> {
    Text(String),
    Features(FeatureLayer),
    Raster(&'a Grid, &'static str),
    Names,
}

/// Checks that none of the files of a world exists.
///
/// # Errors
/// If one exists.
pub fn check_new(recipe: &Path, folder: &Path) -> Result<()> {
    let inner = [COAST, RIVERS, LAKES, PLACES, HEIGHTS, UPLIFT, RAIN].map(|name| folder.join(name));
    let mut paths = inner.iter().map(PathBuf::as_path).chain([recipe]);
    match paths.find(|path| fs::symlink_metadata(path).is_ok()) {
        None => Ok(()),
        Some(path) => {
            let message = format!("{} already exists and is left unchanged; choose another name", path.display());
            Err(Error::new(ErrorKind::File, message))
        }
    }
}

/// Writes all files, or none if one of them exists.
pub fn write(
    (map, rasters, text): (&FmgMap, &Rasters, String),
    recipe: &Path,
    folder: &Path,
    policy: &OutputPolicy,
) -> Result<()> {
    let inner = |name: &str| folder.join(name);
    let mut files = vec![
        (inner(COAST), Content::Features(layers::coast(map))),
        (inner(RIVERS), Content::Features(layers::rivers(map, &rasters.heights))),
        (inner(LAKES), Content::Features(layers::lakes(map))),
        (inner(PLACES), Content::Names),
        (inner(HEIGHTS), Content::Raster(&rasters.heights, "m")),
        (inner(UPLIFT), Content::Raster(&rasters.uplift, "")),
    ];
    if let Some(rain) = &rasters.rain {
        files.push((inner(RAIN), Content::Raster(rain, "")));
    }
    // The recipe is last: if it is there, its files are, too.
    files.push((recipe.to_path_buf(), Content::Text(text)));
    check_new(recipe, folder)?;
    let ready = OutputFolder::ready(folder)?;
    let stage = |(path, content): &(_, Content)| -> Result<Staged> {
        file::stage(&policy.output(path)?, |out| write_content(map, content, out))
    };
    let staged = files.iter().map(stage).collect::<Result<Vec<Staged>>>()?;
    file::commit(staged)?;
    ready.keep();
    Ok(())
}

fn write_content(map: &FmgMap, content: &Content, out: &mut dyn Write) -> io::Result<()> {
    match content {
        Content::Text(text) => out.write_all(text.as_bytes()),
        Content::Features(layer) => write_geojson(out, layer),
        Content::Raster(grid, unit) => writer::write(out, grid, &Layout::of_unit(unit), Spool::in_memory()),
        Content::Names => csv::write_names(out, &layers::names(map), 1),
    }
}

/// Writes features in metres east and north.
pub fn write_geojson(out: &mut dyn Write, layer: &FeatureLayer) -> io::Result<()> {
    geojson::write(out, layer, Crs::Local, STEP)
}
