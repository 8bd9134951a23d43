//! `orogen analyze`.

use std::path::PathBuf;

use orogen::jobs::AnalyzeJob;
use orogen::jobs::analyze::Analysis;

use crate::bar::Bar;
use crate::declared::OptionsOf;
use crate::failure::Failure;
use crate::options::{Opened, RunOptions};
use crate::sink::{Sink, check_png, is_stdout};
use crate::source::title;
use crate::view::SizedView;
use crate::{finite, interrupt, say};

/// Arguments of the command.
#[derive(Debug, Clone, clap::Args)]
pub struct Args {
    /// A recipe file, the name of a preset, or a file of heights (GeoTIFF, .asc, .hgt, ...)
    recipe: PathBuf,
    #[command(flatten)]
    samples: SizedView,
    #[command(flatten)]
    options: OptionsOf<AnalyzeJob>,
    /// Page of charts to write (.png)
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
    #[command(flatten)]
    run: RunOptions,
    /// Print all numbers as JSON instead of a table
    #[arg(long)]
    json: bool,
}

/// Measures the terrain and prints the result.
pub fn run(args: &Args) -> Result<(), Failure> {
    args.samples.each_seed(args.out.as_deref(), |samples, out| measure(&Args { samples, out, ..args.clone() }))
}

fn measure(args: &Args) -> Result<(), Failure> {
    args.out.as_ref().map_or(Ok(()), |out| check_png(out, "the page"))?;
    let options = args.options.read()?;
    let Opened { source, recipe, budget, policy } = args.run.read(&args.recipe, &args.samples.view)?;
    let sink = args.out.as_ref().map(|out| Sink::new(out, &policy)).transpose()?;
    let world = args.run.limits.open(recipe, &budget)?;
    let window = args.samples.window(&world)?;
    let job = AnalyzeJob::new(args.recipe.display().to_string(), &options).with_place(source.dem().is_some());
    let job = if sink.is_some() { job.with_page(title(&args.recipe)) } else { job };
    let (bar, progress) = Bar::new(args.run.quiet);
    let analysis = job
        .run(&world, &window, &progress)
        .map_err(|error| interrupt::explain(error.into(), "nothing was measured"))?;
    finite::tell(&analysis.layer, analysis.finite)?;
    if let Some((sink, page)) = sink.as_ref().zip(analysis.page.as_ref()) {
        sink.picture(page)?;
    }
    progress.finish();
    drop(bar);
    let text = match (args.json, args.run.quiet) {
        (true, _) => analysis.to_json(),
        (false, true) => return Ok(()),
        (false, false) => words(args, &analysis),
    };
    match sink {
        // The page occupies standard output.
        Some(Sink::Stdout) => say::error(text.trim_end()),
        _ => say::out(&text)?,
    }
    Ok(())
}

/// The table, and where the page is.
fn words(args: &Args, analysis: &Analysis) -> String {
    let file = args.out.as_ref().filter(|out| !is_stdout(out));
    analysis.words() + &file.map_or(String::new(), |out| format!("\n{}: the page\n", out.display()))
}
