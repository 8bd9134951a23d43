//! `orogen tilemap`.

use std::path::PathBuf;

use orogen::Progress;
use orogen::recipe::outputs::CLASS;
use orogen::tilemap::TilemapJob;
use orogen::world::HEIGHT;

use crate::bar::Bar;
use crate::declared::OptionsOf;
use crate::failure::Failure;
use crate::options::{Opened, RunOptions};
use crate::sink::is_stdout;
use crate::view::SizedView;
use crate::{interrupt, say};

/// Arguments of the command.
#[derive(Debug, Clone, clap::Args)]
pub struct Args {
    /// A recipe file, the name of a preset, or a file of heights (GeoTIFF, .asc, .hgt, ...)
    #[arg(default_value = orogen::recipe::presets::DEFAULT)]
    recipe: PathBuf,
    #[command(flatten)]
    samples: SizedView,
    #[command(flatten)]
    options: OptionsOf<TilemapJob>,
    /// Output folder; it is created if needed
    #[arg(short, long, value_name = "DIR", default_value = "tilemap")]
    out: PathBuf,
    #[command(flatten)]
    run: RunOptions,
}

/// Makes the map.
pub fn run(args: &Args) -> Result<(), Failure> {
    args.samples.each_output(&args.out, |samples, out| tilemap(&Args { samples, out, ..args.clone() }))
}

fn tilemap(args: &Args) -> Result<(), Failure> {
    if is_stdout(&args.out) {
        return Err(Failure::Usage("`tilemap` writes several files: name a folder with -o".into()));
    }
    let (bar, progress) = Bar::new(args.run.quiet);
    let made = make(args, &progress);
    drop(bar);
    made.and_then(|text| say::out(&text)).map_err(|failure| interrupt::explain(failure, "nothing was written"))
}

fn make(args: &Args, progress: &Progress) -> Result<String, Failure> {
    let Opened { mut recipe, budget, policy, .. } = args.run.read(&args.recipe, &args.samples.view)?;
    let job = TilemapJob::with_options(&args.options.read()?)?;
    let policy = policy.protecting(&job.files);
    let view = TilemapJob::view(&args.samples.view.samples(args.samples.size)?);
    // The classes of a recipe without its own classes depend on the cell of the map.
    let window = view.window(&args.run.limits.open(recipe.clone(), &budget)?, |_| ())?;
    let source_layer = if recipe.outputs().any(|name| name == CLASS) { CLASS } else { HEIGHT };
    job.prepare(&mut recipe, window.cell)?;
    let world = args.run.limits.open(recipe, &budget)?;
    let written = job.to_folder(&world, &window, source_layer, (&args.out, &policy), progress)?;
    if let Some(warning) = &written.warning {
        say::error(&format!("warning: {warning}"));
    }
    Ok(if args.run.quiet { String::new() } else { written.words() })
}
