//! `orogen locate`.

use std::path::PathBuf;

use orogen::io::format::crs::Crs;
use orogen::locate::LocateJob;

use crate::bar::Bar;
use crate::declared::OptionsOf;
use crate::failure::Failure;
use crate::options::Limits;
use crate::source::Source;
use crate::values::arguments::Arguments;
use crate::values::number::cell;
use crate::values::region::place;
use crate::values::seeds::Seeds;
use crate::view::View;
use crate::{interrupt, say};

/// Arguments of the command.
#[derive(Debug, Clone, clap::Args)]
pub struct Args {
    /// A recipe file, the name of a preset, or a file of heights (GeoTIFF, .asc, .hgt, ...)
    recipe: PathBuf,
    #[command(flatten)]
    options: OptionsOf<LocateJob>,
    /// Distance between the samples that are searched, in metres. What is found at a larger cell than the world's is
    /// searched again at the world's [default: the smallest with at most 4 million samples]
    #[arg(long, value_name = "M", value_parser = cell, allow_negative_numbers = true)]
    cell: Option<f64>,
    /// Seed of the world, instead of the recipe's; several seeds, such as 1,2,3 or 1..9, are searched one after the
    /// other
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    seed: Option<Seeds>,
    #[command(flatten)]
    arguments: Arguments,
    /// Coordinate reference system of the world, such as EPSG:32632
    #[arg(long, value_name = "EPSG:N")]
    crs: Option<Crs>,
    /// Position of the world's north-west corner in the CRS: easting and northing, or longitude and latitude
    #[arg(long, value_name = "E,N", value_parser = place, allow_hyphen_values = true)]
    origin: Option<[f64; 2]>,
    #[command(flatten)]
    limits: Limits,
    /// Print no progress
    #[arg(short, long, help_heading = "Output")]
    quiet: bool,
    /// Print the places as JSON
    #[arg(long)]
    json: bool,
}

/// Finds the places and prints them.
pub fn run(args: &Args) -> Result<(), Failure> {
    let Args { seed, arguments, crs, origin, .. } = args.clone();
    let view = View { seed, arguments, crs, origin, ..View::default() };
    view.each_seed(None, |view, _| locate(args, &view))
}

fn locate(args: &Args, view: &View) -> Result<(), Failure> {
    let job = LocateJob::new(&args.options.read()?)?.with_cell(args.cell);
    let source = Source::find(&args.recipe)?;
    let budget = args.limits.budget();
    let mut recipe = view.recipe(&source, &budget)?;
    job.prepare(&mut recipe)?;
    let world = args.limits.open(recipe, &budget)?;
    let (bar, progress) = Bar::new(args.quiet);
    let found = job.run(&world, &progress).map_err(|error| interrupt::explain(error.into(), "nothing was found"))?;
    progress.finish();
    drop(bar);
    say::out(&if args.json { found.to_json() } else { found.words() })?;
    Ok(())
}
