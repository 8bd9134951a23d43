//! `orogen generate`.

use std::path::{Path, PathBuf};
use std::time::Instant;

use orogen::Progress;
use orogen::grid::words::number;
use orogen::io::file::OutputFolder;
use orogen::recipe::RecipeSource;
use orogen::world::{HEIGHT, LAKES};

use crate::bar::Bar;
use crate::device::DeviceOption;
use crate::failure::Failure;
use crate::options::{Opened, RunOptions};
use crate::pictures::{self, FILES, Report};
use crate::sink::is_stdout;
use crate::source::Source;
use crate::view::SizedView;
use crate::{finite, interrupt, say, watch};

/// Arguments of the command.
#[derive(Debug, Clone, clap::Args)]
pub struct Args {
    /// A recipe file, the name of a preset, or a file of heights (GeoTIFF, .asc, .hgt, ...)
    #[arg(default_value = orogen::recipe::presets::DEFAULT)]
    recipe: PathBuf,
    #[command(flatten)]
    samples: SizedView,
    /// Output folder; it is created if needed
    #[arg(short, long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
    #[command(flatten)]
    device: DeviceOption,
    #[command(flatten)]
    run: RunOptions,
    /// Print the summary as JSON instead of text
    #[arg(long)]
    json: bool,
    /// Keep running, and make the terrain again whenever the recipe file changes
    #[arg(long)]
    watch: bool,
}

/// Memory for writing the pictures beside the heights, in bytes.
const ENCODERS: u64 = 2 << 20;

/// Makes the terrain.
pub fn run(args: &Args) -> Result<(), Failure> {
    args.samples.each_output(&args.out, |samples, out| generate(&Args { samples, out, ..args.clone() }))
}

fn generate(args: &Args) -> Result<(), Failure> {
    if is_stdout(&args.out) {
        return Err(Failure::Usage(
            "`generate` writes several files: name a folder with -o, or use `orogen export` for a single file".into(),
        ));
    }
    let source = Source::find(&args.recipe)?;
    let again = |progress: &Progress| make(args, progress);
    match (&source, args.watch) {
        (Source::Named(RecipeSource::File(path)), true) => watch::watch(path, args.run.quiet, again),
        (Source::Named(RecipeSource::Dem(path)), true) => Err(Failure::Usage(format!(
            "--watch needs a recipe, and {} is a file of heights; use it in a recipe, in a node with op = \"dem\"",
            path.display()
        ))),
        (Source::Stdin, true) => {
            Err(Failure::Usage("--watch needs a recipe file, not standard input; name the file".into()))
        }
        (Source::Named(RecipeSource::Preset(preset)), true) => Err(Failure::Usage(format!(
            "--watch needs a recipe file, and `{0}` is a preset; `orogen new NAME --preset {0}` writes it to a file",
            preset.name
        ))),
        (_, false) => {
            let (bar, progress) = Bar::new(args.run.quiet);
            let made = make(args, &progress);
            drop(bar);
            made.and_then(|text| say::out(&text)).map_err(|failure| interrupt::explain(failure, "nothing was written"))
        }
    }
}

/// Approximate time for painting, compressing and writing a sample, in nanoseconds.
const WRITING: f64 = 150.0;

/// Makes the terrain once, and returns the text for standard output.
fn make(args: &Args, progress: &Progress) -> Result<String, Failure> {
    let begun = Instant::now();
    let Opened { recipe, budget, policy, .. } = args.run.read(&args.recipe, &args.samples.view)?;
    let (world, card) = args.device.open(&args.run.limits, recipe, &budget)?;
    let window = args.samples.window(&world)?;
    let outputs = pictures::outputs(&args.out, &policy)?;
    let mut layers = vec![HEIGHT];
    layers.extend(world.recipe().outputs().find(|name| *name == LAKES));
    // The pictures are encoded in parallel, in bands of rows.
    let (plan, _pictures) = world.plan_beside(&layers, &window, ENCODERS)?;
    let folder = OutputFolder::ready(&args.out)?;
    let [making, writing] = progress.parts([world.work(&plan)?, WRITING * window.len() as f64]);
    let mut grids = world.run(&plan, &making)?.into_iter();
    let card = card.used();
    let (Some(grid), lakes) = (grids.next(), grids.next()) else {
        return Ok(String::new());
    };
    finite::check(HEIGHT, &grid)?;
    let report = pictures::write(&outputs, world.recipe(), &grid, lakes.as_ref(), || begun.elapsed().as_secs_f64())?;
    writing.finish();
    folder.keep();
    Ok(match (args.json, args.run.quiet) {
        (true, _) => report.json(),
        (false, true) => String::new(),
        (false, false) => words(&report, &args.out, card.as_deref()),
    })
}

/// The final message.
fn words(report: &Report, folder: &Path, card: Option<&str>) -> String {
    let Report { seed, width, height, cell, height_min, height_max, height_mean, land_share, seconds, .. } = report;
    let across = |samples: &usize| *samples as f64 * cell / 1000.0;
    let sea = match land_share {
        share if *share >= 1.0 => String::new(),
        share => format!(", {:.0} % land", share * 100.0),
    };
    let on = card.map_or(String::new(), |card| format!(" on {card}: a preview, not the exact bits of the processor"));
    let flat = if height_min == height_max { "; the terrain is flat, so the grey pictures are black" } else { "" };
    format!(
        "{}: {}\n{width} x {height} samples of {} m, {:.1} x {:.1} km, seed {seed}\nheights {height_min:.1} to \
         {height_max:.1} m, {height_mean:.1} m on average{sea}{flat}\nmade in {seconds:.1} s{on}\n",
        folder.display(),
        FILES.join("  "),
        number(*cell),
        across(width),
        across(height),
    )
}
