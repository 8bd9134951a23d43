//! `orogen explain`.

use std::path::PathBuf;

use crate::failure::Failure;
use crate::options::{Limits, View};
use crate::source::Source;
use crate::{say, view};

/// What it takes.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// A recipe's file, the name of a preset, or a file of heights (GeoTIFF, .asc, .hgt, ...)
    #[arg(default_value = orogen::recipe::presets::DEFAULT)]
    recipe: PathBuf,
    #[command(flatten)]
    view: View,
    /// The layer to explain [default: all]
    #[arg(long, value_name = "L")]
    layer: Option<String>,
    #[command(flatten)]
    limits: Limits,
}

/// Prints the plan.
pub fn run(args: &Args) -> Result<(), Failure> {
    let mut recipe = Source::find(&args.recipe)?.read()?;
    recipe.world.seed = args.view.seed.unwrap_or(recipe.world.seed);
    let layers: Vec<String> = match &args.layer {
        Some(layer) => vec![layer.clone()],
        None => recipe.outputs().map(String::from).collect(),
    };
    let layers: Vec<&str> = layers.iter().map(String::as_str).collect();
    let world = args.limits.open(recipe)?;
    let plan = world.plan(&layers, &view::whole(&world, &args.view)?)?;
    say::out(&world.explain(&plan))
}
